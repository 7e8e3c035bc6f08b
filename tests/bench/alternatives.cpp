// SPDX-License-Identifier: MIT
// Compiled once per instruction set; MAKE_ALTERNATIVE names the factory of this one.
#include "tests/bench/alternatives.h"

#include <algorithm>
#include <vector>

#include <Eigen/Dense>

namespace framewatch::bench {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
constexpr int kRowsAtOnce =
    4096;  // of the design matrix; problems of the measured sizes fit into memory

/// Dense rows and right-hand sides of instants.
class Rows {
 public:
  Rows(const Pattern& pattern, int instants)
      : pattern_(pattern),
        rows_(RowMajor::Zero(instants * pattern.equations, 2 * pattern.elements)),
        right_(instants * pattern.equations) {}

  int stride() const { return 2 * pattern_.elements + pattern_.equations; }
  void fill(const double* motion, int instants) {
    for (int t = 0; t < instants; ++t, motion += stride()) {
      for (int k = 0; k < pattern_.entries; ++k) {
        const int row = t * pattern_.equations + pattern_.equation[k];
        const int e = pattern_.element[k];
        rows_(row, e) = pattern_.coefficient[k] * motion[e];
        rows_(row, pattern_.elements + e) = pattern_.coefficient[k] * motion[pattern_.elements + e];
      }
      for (int i = 0; i < pattern_.equations; ++i)
        right_[t * pattern_.equations + i] = motion[2 * pattern_.elements + i];
    }
  }
  /// Adds the outer products of all rows: gram += rows' rows.
  void multiply(Eigen::MatrixXd& gram, Eigen::VectorXd& right, int instants) const {
    const auto rows = rows_.topRows(instants * pattern_.equations);
    gram.noalias() += rows.transpose() * rows;
    right.noalias() += rows.transpose() * right_.head(rows.rows());
  }
  /// Updates the lower half only, with rows added or subtracted.
  void update(Eigen::MatrixXd& gram, Eigen::VectorXd& right, int instants, double sign) const {
    const auto rows = rows_.topRows(instants * pattern_.equations);
    gram.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose(), sign);
    right.noalias() += sign * (rows.transpose() * right_.head(rows.rows()));
  }

 private:
  Pattern pattern_;
  RowMajor rows_;
  Eigen::VectorXd right_;
};

class Naive : public Alternative {
 public:
  explicit Naive(const Pattern& p)
      : at_once_(std::clamp(kRowsAtOnce / p.equations, 1, 500)),
        rows_(p, at_once_),
        gram_(2 * p.elements, 2 * p.elements),
        right_(2 * p.elements) {}

  void solve(const double* motion, int instants, int counted) override {
    gram_.setZero();
    right_.setZero();
    for (int t = instants - counted; t < instants; t += at_once_) {
      const int count = std::min(at_once_, instants - t);
      rows_.fill(motion + t * static_cast<long>(rows_.stride()), count);
      rows_.multiply(gram_, right_, count);
    }
    if (counted == 0) gram_.setIdentity();
    llt_.compute(gram_);
    solution_ = llt_.solve(right_);
  }
  const double* solution() const override { return solution_.data(); }

 private:
  int at_once_;
  Rows rows_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd right_, solution_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
};

template <typename Factor>
class Recursive : public Alternative {
 public:
  explicit Recursive(const Pattern& p)
      : rows_(p, 1),
        gram_(Eigen::MatrixXd::Zero(2 * p.elements, 2 * p.elements)),
        right_(Eigen::VectorXd::Zero(2 * p.elements)) {}

  void solve(const double* motion, int instants, int counted) override {
    const double* newest = motion + (instants - 1) * static_cast<long>(rows_.stride());
    if (!started_) {
      for (int t = instants - counted; t < instants; ++t) {
        rows_.fill(motion + t * static_cast<long>(rows_.stride()), 1);
        rows_.update(gram_, right_, 1, 1);
      }
      started_ = true;
      return;
    }
    rows_.fill(newest, 1);
    rows_.update(gram_, right_, 1, 1);
    rows_.fill(motion - rows_.stride(), 1);
    rows_.update(gram_, right_, 1, -1);
    factor_.compute(gram_);
    solution_ = factor_.solve(right_);
  }
  const double* solution() const override { return solution_.data(); }

 private:
  Rows rows_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd right_, solution_;
  Factor factor_;
  bool started_ = false;
};

}  // namespace

__attribute__((visibility("default"))) std::unique_ptr<Alternative> MAKE_ALTERNATIVE(
    Method method, const Pattern& pattern) {
  if (!__builtin_cpu_supports(INSTRUCTION_SET)) return nullptr;
  switch (method) {
    case Method::naive:
      return std::make_unique<Naive>(pattern);
    case Method::recursive_llt:
      return std::make_unique<Recursive<Eigen::LLT<Eigen::MatrixXd>>>(pattern);
    case Method::recursive_ldlt:
      return std::make_unique<Recursive<Eigen::LDLT<Eigen::MatrixXd>>>(pattern);
  }
  return nullptr;
}

}  // namespace framewatch::bench
