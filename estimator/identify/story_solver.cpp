#include "estimator/identify/story_solver.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "estimator/identify/kernels.h"

namespace framewatch {
namespace {

/// A pivot below this share of its own diagonal entry is rounding error.
constexpr double kSmallestPivot = 1e-13;

}  // namespace

StorySolver::StorySolver(const FloorLayout& layout) : layout_(layout) {
  const int stride = padded(layout.own() + 2 * layout.frames() + 1);
  factor_stride_ = static_cast<std::size_t>(layout.own() * stride);
  front_.assign(static_cast<std::size_t>(stride * stride), 0.0);
  factor_.assign(factor_stride_ * static_cast<std::size_t>(layout.floors()), 0.0);
  const int passed = 2 * layout.frames() + 1;
  carry_.assign(static_cast<std::size_t>(passed * passed), 0.0);
  pivot_floor_.assign(static_cast<std::size_t>(layout.own()), 0.0);
  const auto unknowns = static_cast<std::size_t>(layout.unknowns());
  x_.assign(unknowns, 1.0);
  information_.assign(unknowns, 0.0);
  usable_.assign(unknowns, 0);
  for (Eigen::MatrixXd* work : {&upper_, &middle_, &inverse_})
    work->setZero(layout.own(), layout.own());
  for (Eigen::MatrixXd* work : {&coupling_, &coupled_})
    work->setZero(layout.own(), 2 * layout.frames());
}

void StorySolver::gather_information(const WindowSums& sums) {
  std::fill(information_.begin(), information_.end(), 0.0);
  response_energy_ = 0;
  for (int floor = 0; floor < layout_.floors(); ++floor) {
    const SumsShape::Floor& shape = sums.shape().floor[static_cast<std::size_t>(floor)];
    std::size_t at = shape.offset;
    for (int i = 0; i < shape.front; ++i) {
      const std::size_t diagonal = at + static_cast<std::size_t>(i - packed_row_begin(i));
      const double sum =
          sums.newest()[diagonal] + sums.middle()[diagonal] + sums.oldest()[diagonal];
      if (i + 1 == shape.front)
        response_energy_ += sum;
      else
        information_[static_cast<std::size_t>(floor * layout_.own() + i)] += sum;
      at += static_cast<std::size_t>(shape.stride - packed_row_begin(i));
    }
  }
}

void StorySolver::factor(const WindowSums& sums, const std::vector<double>& prior,
                         const NoiseShare& noise) {
  const int own = layout_.own();
  const int passed = 2 * layout_.frames();
  gather_information(sums);
  double prior_energy = 0;
  std::fill(carry_.begin(), carry_.end(), 0.0);
  const auto carry = [&](int i, int j) -> double& {
    return carry_[static_cast<std::size_t>(i * (passed + 1) + j)];
  };
  for (int floor = 0; floor < layout_.floors(); ++floor) {
    const SumsShape::Floor& shape = sums.shape().floor[static_cast<std::size_t>(floor)];
    const int stride = shape.stride;
    const int last = shape.front - 1;
    double* a = front_.data();
    const NoiseShare::TakenOff taken_off = noise.taken_off(floor);
    kernels::sum_into_front(sums.newest() + shape.offset, sums.middle() + shape.offset,
                            sums.oldest() + shape.offset, taken_off.scale, taken_off.packed, a,
                            shape.front, stride);
    if (floor > 0) {
      // What the floor below knows about this story's frames: the Schur complement of its rows.
      for (int i = 0; i < passed; ++i) {
        for (int j = i; j < passed; ++j) a[i * stride + j] += carry(i, j);
        a[i * stride + last] += carry(i, passed);
      }
      a[last * stride + last] += carry(passed, passed);
    }
    for (int p = 0; p < own; ++p) {
      const auto unknown = static_cast<std::size_t>(floor * own + p);
      a[p * stride + p] += prior[unknown];
      a[p * stride + last] += prior[unknown];
      prior_energy += prior[unknown];
      pivot_floor_[static_cast<std::size_t>(p)] =
          kSmallestPivot * (information_[unknown] + prior[unknown]);
    }
    kernels::partial_cholesky(a, own, shape.front, stride, pivot_floor_.data(),
                              &usable_[static_cast<std::size_t>(floor * own)]);
    std::copy(a, a + own * stride,
              factor_.begin() +
                  static_cast<std::ptrdiff_t>(static_cast<std::size_t>(floor) * factor_stride_));
    for (int i = 0; i <= shape.front - 1 - own; ++i)
      for (int j = i; j <= shape.front - 1 - own; ++j) {
        const bool response_column = j == shape.front - 1 - own;
        const bool response_row = i == shape.front - 1 - own;
        carry(response_row ? passed : i, response_column ? passed : j) =
            a[(own + i) * stride + own + j];
      }
  }
  residual_energy_ = carry(passed, passed) + prior_energy;

  for (int floor = layout_.floors() - 1; floor >= 0; --floor) {
    const int next = layout_.next(floor);
    const int stride = padded(layout_.front(floor));
    const double* rows = factor_rows(floor);
    double* x = &x_[static_cast<std::size_t>(floor * own)];
    for (int p = own - 1; p >= 0; --p) {
      const double* row = rows + p * stride;
      double sum = row[own + next];
      for (int j = 0; j < next; ++j) sum -= row[own + j] * x[own + j];
      for (int j = p + 1; j < own; ++j) sum -= row[j] * x[j];
      x[p] = usable(floor * own + p) ? sum / row[p] : 1.0;
    }
  }
}

void StorySolver::solve(std::vector<double>& right, int columns) const {
  const int own = layout_.own();
  const auto at = [&](int unknown) { return &right[static_cast<std::size_t>(unknown * columns)]; };
  for (int floor = 0; floor < layout_.floors(); ++floor) {
    const int next = layout_.next(floor);
    const int stride = padded(layout_.front(floor));
    const double* rows = factor_rows(floor);
    for (int p = 0; p < own; ++p) {
      double* pivot = at(floor * own + p);
      const double* row = rows + p * stride;
      for (int c = 0; c < columns; ++c) pivot[c] = row[p] > 0 ? pivot[c] / row[p] : 0.0;
      for (int j = p + 1; j < own + next; ++j) {
        double* target = at(floor * own + j);
        for (int c = 0; c < columns; ++c) target[c] -= row[j] * pivot[c];
      }
    }
  }
  for (int floor = layout_.floors() - 1; floor >= 0; --floor) {
    const int next = layout_.next(floor);
    const int stride = padded(layout_.front(floor));
    const double* rows = factor_rows(floor);
    for (int p = own - 1; p >= 0; --p) {
      double* pivot = at(floor * own + p);
      const double* row = rows + p * stride;
      for (int j = p + 1; j < own + next; ++j) {
        const double* known = at(floor * own + j);
        for (int c = 0; c < columns; ++c) pivot[c] -= row[j] * known[c];
      }
      for (int c = 0; c < columns; ++c) pivot[c] = row[p] > 0 ? pivot[c] / row[p] : 0.0;
    }
  }
}

void StorySolver::inverse_diagonal(std::vector<double>& diagonal) {
  // Z = inverse. With the factor's rows [U W] of a story: Z_own = U^-1 (I + W Z_next W^T) U^-T.
  const int own = layout_.own();
  diagonal.assign(static_cast<std::size_t>(layout_.unknowns()), 0.0);
  for (int floor = layout_.floors() - 1; floor >= 0; --floor) {
    const int next = layout_.next(floor);
    const int stride = padded(layout_.front(floor));
    const double* rows = factor_rows(floor);
    upper_.setZero();
    middle_.setZero();
    for (int p = 0; p < own; ++p) {
      const bool usable_row = rows[p * stride + p] > 0;
      for (int j = p; j < own; ++j)
        upper_(p, j) = usable_row ? rows[p * stride + j] : (j == p ? 1.0 : 0.0);
      for (int j = 0; j < next; ++j) coupling_(p, j) = rows[p * stride + own + j];
      // An unusable unknown is held fixed: it has no variance to pass on.
      middle_(p, p) = usable_row ? 1.0 : 0.0;
    }
    if (next > 0) {
      coupled_.noalias() = coupling_ * inverse_.topLeftCorner(next, next);
      middle_.noalias() += coupled_ * coupling_.transpose();
    }
    upper_.triangularView<Eigen::Upper>().solveInPlace(middle_);
    middle_.transposeInPlace();
    upper_.triangularView<Eigen::Upper>().solveInPlace(middle_);
    for (int p = 0; p < own; ++p)
      diagonal[static_cast<std::size_t>(floor * own + p)] = middle_(p, p);
    inverse_ = middle_;
  }
}

}  // namespace framewatch
