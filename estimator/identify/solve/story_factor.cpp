#include "estimator/identify/solve/story_factor.h"

#include <algorithm>

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
  // Z = inverse. With the factor's rows [U W] of a story: Z_own = U^-1 (I + W Z_next W^T) U^-T.
  const int own = layout_.own();
  const int next = layout_.next(floor);
  const int stride = factor.row_stride(floor);
  const double* rows = factor.rows(floor);
  std::fill(middle_.begin(), middle_.end(), 0.0);
  for (int p = 0; p < own; ++p)  // what is held fixed has no variance to pass on
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

}  // namespace framewatch::estimator
