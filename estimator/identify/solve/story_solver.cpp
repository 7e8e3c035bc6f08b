// SPDX-License-Identifier: MIT
#include "estimator/identify/solve/story_solver.h"

#include <algorithm>
#include <cmath>

#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {

void StoryFactor::forward(int floor, double* right, int columns) const {
  kernels::in_use->forward_columns(rows(floor), row_stride(floor), layout_.own(),
                                   layout_.next(floor), right + floor * layout_.own() * columns,
                                   columns);
}

void StoryFactor::backward(int floor, double* right, int columns) const {
  kernels::in_use->backward_columns(rows(floor), row_stride(floor), layout_.own(),
                                    layout_.next(floor), right + floor * layout_.own() * columns,
                                    columns);
}

InverseDiagonal::InverseDiagonal(const FloorLayout& layout)
    : layout_(layout), columns_(padded(layout.own())) {
  const auto size = static_cast<std::size_t>(layout.own() * columns_);
  for (std::vector<double>* work : {&inverse_, &coupled_, &middle_}) work->assign(size, 0.0);
  transposed_.assign(static_cast<std::size_t>(layout.shared() * columns_), 0.0);
}

void InverseDiagonal::step(const StoryFactor& factor, int floor, double* diagonal) {
  // Z is the inverse. With the factor's rows [U W] of a story: Z_own = U^-1 (I + W Z_next W^T)
  // U^-T.
  const int own = layout_.own();
  const int next = layout_.next(floor);
  const int stride = factor.row_stride(floor);
  const double* rows = factor.rows(floor);
  std::fill(middle_.begin(), middle_.end(), 0.0);
  for (int p = 0; p < own; ++p)  // a fixed unknown has no variance to pass on
    middle_[static_cast<std::size_t>(p * columns_ + p)] = rows[p * stride + p] > 0 ? 1 : 0;
  if (next > 0) {
    for (int p = 0; p < own; ++p)
      for (int j = 0; j < next; ++j)
        transposed_[static_cast<std::size_t>(j * columns_ + p)] = rows[p * stride + own + j];
    std::fill(coupled_.begin(), coupled_.end(), 0.0);
    kernels::in_use->multiply_add(rows + own, stride, own, next, inverse_.data(), coupled_.data(),
                                  columns_);
    kernels::in_use->multiply_add(coupled_.data(), columns_, own, next, transposed_.data(),
                                  middle_.data(), columns_);
  }
  kernels::in_use->backward_columns(rows, stride, own, 0, middle_.data(), columns_);
  for (int p = 0; p < own; ++p)
    for (int q = 0; q < own; ++q)
      inverse_[static_cast<std::size_t>(q * columns_ + p)] =
          middle_[static_cast<std::size_t>(p * columns_ + q)];
  kernels::in_use->backward_columns(rows, stride, own, 0, inverse_.data(), columns_);
  for (int p = 0; p < own; ++p)
    diagonal[floor * own + p] = inverse_[static_cast<std::size_t>(p * columns_ + p)];
}

namespace {

/// A pivot below this share of its diagonal entry is rounding error.
constexpr double kSmallestPivot = 1e-13;

}  // namespace

StorySolver::StorySolver(const FloorLayout& layout) : layout_(layout), factor_(layout) {
  const int stride = padded(layout.most_front());
  for (std::vector<double>& front : front_)
    front.assign(static_cast<std::size_t>(stride * stride), 0.0);
  pivot_floor_.assign(static_cast<std::size_t>(layout.own()), 0.0);
  const auto unknowns = static_cast<std::size_t>(layout.unknowns());
  x_.assign(unknowns, 1.0);
  information_.assign(unknowns, 0.0);
  usable_.assign(unknowns, 0);
}

void StorySolver::gather_information(const WindowParts& sums, int floor) {
  const GramShape::Floor& shape = sums.shape->floor[static_cast<std::size_t>(floor)];
  const int own = layout_.own();
  std::size_t at = shape.offset;
  for (int i = 0; i < shape.front; ++i) {
    const std::size_t diagonal = at + static_cast<std::size_t>(i - packed_row_begin(i));
    const double sum = sums.newest[diagonal] + sums.middle[diagonal] + sums.oldest[diagonal];
    const auto unknown = static_cast<std::size_t>(floor * own + i);
    if (i + 1 == shape.front)
      response_energy_ += sum;
    else if (i < own && !(floor > 0 && i < layout_.shared()))
      information_[unknown] = sum;
    else if (i < own)
      information_[unknown] += sum;
    else
      information_[unknown] = sum;
    at += static_cast<std::size_t>(shape.stride - packed_row_begin(i));
  }
}

void StorySolver::factor(const WindowParts& sums, const std::vector<double>& prior,
                         const std::vector<double>& centre, const NoiseCompensation& noise) {
  const int own = layout_.own();
  const int passed = layout_.shared();
  response_energy_ = 0;
  double prior_energy = 0;
  for (int floor = 0; floor < layout_.floors(); ++floor) {
    const GramShape::Floor& shape = sums.shape->floor[static_cast<std::size_t>(floor)];
    const int stride = shape.stride;
    const int last = shape.front - 1;
    double* a = front_[floor % 2].data();
    const NoiseCompensation::Part compensation = noise.compensation(floor);
    kernels::in_use->sum_into_front(sums.newest + shape.offset, sums.middle + shape.offset,
                                    sums.oldest + shape.offset, compensation.scale,
                                    compensation.values, a, shape.front, stride);
    gather_information(sums, floor);
    if (floor > 0) {
      // The Schur complement of the floor below carries its information about this story's frames.
      const int from_stride = padded(layout_.front(floor - 1));
      const double* from = front_[1 - floor % 2].data() + own * from_stride + own;
      for (int i = 0; i < passed; ++i, from += from_stride) {
        for (int j = i; j < passed; ++j) a[i * stride + j] += from[j];
        a[i * stride + last] += from[passed];
      }
      a[last * stride + last] += from[passed];
    }
    for (int p = 0; p < own; ++p) {
      const auto unknown = static_cast<std::size_t>(floor * own + p);
      a[p * stride + p] += prior[unknown];
      a[p * stride + last] += prior[unknown] * centre[unknown];
      prior_energy += prior[unknown] * centre[unknown] * centre[unknown];
      pivot_floor_[static_cast<std::size_t>(p)] =
          kSmallestPivot * (information_[unknown] + prior[unknown]);
    }
    kernels::in_use->partial_cholesky(a, factor_.rows(floor), own, shape.front, stride,
                                      pivot_floor_.data(),
                                      &usable_[static_cast<std::size_t>(floor * own)]);
    if (floor + 1 == layout_.floors()) residual_energy_ = a[last * stride + last] + prior_energy;
  }
  for (int floor = layout_.floors() - 1; floor >= 0; --floor)
    kernels::in_use->substitute_back(factor_.rows(floor), factor_.row_stride(floor), own,
                                     layout_.next(floor),
                                     &x_[static_cast<std::size_t>(floor * own)]);
}

}  // namespace framewatch::estimator
