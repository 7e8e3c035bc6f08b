// SPDX-License-Identifier: MIT
#include "estimator/diagnose/locate/large_lists.h"

#include <algorithm>
#include <cmath>

#include "estimator/diagnose/fit/bin_products.h"
#include "estimator/diagnose/fit/normal_equations.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/diagnose/spectra/row_gram.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

namespace {

constexpr int kParts = 4;  ///< of the bins of a record, processed in parallel
/// Number of lists up to which products of their rows cost less than those of all equations.
constexpr std::size_t kFewLists = 8;

/// Adds real(C^H c) of a list's orthonormal directions. c: their products with the residual, which
/// is the last of the columns C.
void add_last(const PlaceProducts& places, VectorXd& sum) {
  for (Index i = 0; i < places.columns.rows(); ++i) {
    const Complex last = places.columns(i, places.columns.cols() - 1);
    sum += places.columns.row(i).real().transpose() * last.real() +
           places.columns.row(i).imag().transpose() * last.imag();
  }
}

/// Adds it for a bin whose products are not computed.
void add_last(const Whitened& system, Index bin, const std::vector<CandidatePlace>& places,
              BinProducts& products, VectorXd& sum) {
  const MatrixXcd basis = candidate_basis(system, bin, places);
  for (Index i = 0; i < basis.cols(); ++i) {
    const Eigen::RowVectorXcd columns = products.with_rows(bin, basis.col(i));
    const Complex last = columns[columns.size() - 1];
    sum += columns.real().transpose() * last.real() + columns.imag().transpose() * last.imag();
  }
}

/// The directions of a list's places. Those of axes change from bin to bin.
class Directions {
 public:
  explicit Directions(const std::vector<CandidatePlace>& places) {
    for (const CandidatePlace& place : places) {
      if (place.kind == CandidatePlace::Kind::axis) {
        forces_.emplace_back();
        axes_.push_back(place.axis);
      }
      for (Index c = 0; c < place.directions.cols(); ++c) {
        forces_.push_back(BinProducts::of_force(place.directions.col(c)));
        axes_.push_back(-1);
      }
    }
  }

  Index count() const { return static_cast<Index>(forces_.size()); }

  /// Adds the same sum as add_last(), without orthonormal directions.
  void add(const BinProducts& products, Eigen::Ref<VectorXd> sum) const {
    const Index count = this->count();
    MatrixXcd square(count, count);
    VectorXcd last(count);
    for (Index i = 0; i < count; ++i) {
      last[i] = products.with_last(at(products, i));
      for (Index j = 0; j <= i; ++j) {
        square(i, j) = products.between(at(products, i), at(products, j));
        square(j, i) = std::conj(square(i, j));
      }
      if (count > 1) square(i, i) *= 1 + kRegular;
    }
    const VectorXcd size =
        count == 1 ? VectorXcd(last / square(0, 0).real()) : VectorXcd(solve_ldlt(square, last));
    if (!size.allFinite()) return;
    for (Index i = 0; i < count; ++i) products.add_columns(at(products, i), size[i], sum);
  }

 private:
  static constexpr double kRegular = 1e-9;

  const BinProducts::Direction& at(const BinProducts& products, Index i) const {
    const int axis = axes_[static_cast<std::size_t>(i)];
    return axis < 0 ? forces_[static_cast<std::size_t>(i)] : products.of_axis(axis);
  }

  std::vector<BinProducts::Direction> forces_;
  std::vector<int> axes_;  ///< -1: a force
};

}  // namespace

std::vector<MatrixXd> without_sampled(const MatrixXd& square, const Linearised& at,
                                      std::size_t record, const std::vector<Index>& kept,
                                      std::span<const std::vector<CandidatePlace>> lists) {
  const std::vector<SampledBin> sampled = sampled_bins(at, record);
  std::vector<RowGram> along(lists.size(), RowGram(square.cols()));
  std::vector<VectorXd> last(lists.size(), VectorXd::Zero(square.cols()));
  const std::vector<Directions> directions(lists.begin(), lists.end());
  BinProducts products(at, record, kept);
  auto next = sampled.begin();
  const Whitened& system = at.systems[record];
  for (Index b = 0; b < system.bins(); ++b) {
    const bool taken = next != sampled.end() && next->bin == b;
    if (!taken && lists.size() <= kFewLists) {
      for (std::size_t i = 0; i < lists.size(); ++i)
        add_last(system, b, lists[i], products, last[i]);
      continue;
    }
    products.compute(b);
    const double root = taken ? std::sqrt(next->weight) : 0;
    if (taken) ++next;
    for (std::size_t i = 0; i < lists.size(); ++i) {
      if (!taken && directions[i].count() == 1) {
        directions[i].add(products, last[i]);
        continue;
      }
      const PlaceProducts places = place_products(products, lists[i]);
      add_last(places, last[i]);
      if (!taken) continue;
      const Index count = places.columns.rows();
      auto rows = along[i].rows(2 * count);
      rows.topRows(count) = root * places.columns.real();
      rows.bottomRows(count) = root * places.columns.imag();
      along[i].add();
    }
  }
  std::vector<MatrixXd> out;
  const Index end = square.cols() - 1;
  for (std::size_t i = 0; i < lists.size(); ++i) {
    MatrixXd& one = out.emplace_back(square - along[i].sum());
    one.col(end) = square.col(end) - last[i];
    one.row(end) = one.col(end).transpose();
  }
  return out;
}

std::vector<double> rough_misfits(const Linearised& at, const std::vector<Index>& kept,
                                  const std::vector<MatrixXd>& squares,
                                  const std::vector<std::vector<CandidatePlace>>& lists,
                                  const Parallel& parallel) {
  const auto count = static_cast<Index>(kept.size());
  MatrixXd square = MatrixXd::Zero(count + 1, count + 1);
  for (const MatrixXd& one : squares) square += one;
  MatrixXd normal = square.topLeftCorner(count, count);
  for (Index i = 0; i < count; ++i)
    normal(i, i) += at.prior[kept[static_cast<std::size_t>(i)]] / at.level;
  normal.diagonal() *= 1 + 1e-9;
  const Ldlt factor(normal);
  std::vector<Directions> directions(lists.begin(), lists.end());
  const auto parts = static_cast<int>(at.systems.size()) * kParts;
  std::vector<MatrixXd> last(static_cast<std::size_t>(parts));
  run_all(parallel, parts, [&](int part) {
    const auto r = static_cast<std::size_t>(part / kParts);
    MatrixXd& sum = last[static_cast<std::size_t>(part)];
    sum = MatrixXd::Zero(count + 1, static_cast<Index>(lists.size()));
    const Index bins = at.systems[r].bins(), end = bins * (part % kParts + 1) / kParts;
    BinProducts products(at, r, kept);
    for (Index b = bins * (part % kParts) / kParts; b < end; ++b) {
      products.compute(b);
      for (std::size_t i = 0; i < lists.size(); ++i)
        directions[i].add(products, sum.col(static_cast<Index>(i)));
    }
  });
  std::vector<double> out;
  for (Index i = 0; i < static_cast<Index>(lists.size()); ++i) {
    VectorXd rest = square.col(count);
    for (const MatrixXd& of_part : last) rest -= of_part.col(i);
    const VectorXd gradient = rest.head(count);
    out.push_back(rest[count] - gradient.dot(factor.solve(gradient)));
  }
  return out;
}

}  // namespace framewatch::estimator
