#include "estimator/identify/solve/mass_errors.h"

#include <algorithm>
#include <cmath>

#include "estimator/identify/elements/fixed_signs.h"
#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {

MassErrors::MassErrors(const FloorLayout& layout)
    : layout_(layout), factor_(layout), next_step_(2 * layout.floors()) {
  static_assert(kDraws % kLane == 0);
  const auto unknowns = static_cast<std::size_t>(layout.unknowns());
  columns_.assign(unknowns * kDraws, 0.0);
  new_error_.assign(unknowns, 0.0);
  error_.assign(unknowns, 0.0);
}

void MassErrors::begin(StorySolver& solver, const GramShape& shape, const std::vector<double>& sums,
                       double tolerance) {
  solver.swap_factor(factor_);
  shape_ = &shape;
  sums_ = sums.data();
  tolerance_ = tolerance;
  std::fill(columns_.begin(), columns_.end(), 0.0);
  next_step_ = 0;
}

/// The floor's part of the right-hand side, times the error of its mass.
void MassErrors::load(int floor) {
  const GramShape::Floor& shape = shape_->floor[static_cast<std::size_t>(floor)];
  const int response = shape.front - 1;
  std::size_t at = shape.offset;
  for (int i = 0; i < response; ++i) {
    const int begin = packed_row_begin(i);
    const double right = sums_[at + static_cast<std::size_t>(response - begin)];
    double* to = column(floor * layout_.own() + i);
    for (int draw = 0; draw < kDraws; ++draw)
      to[draw] += tolerance_ * fixed_sign(floor, draw) * right;
    at += static_cast<std::size_t>(shape.stride - begin);
  }
}

bool MassErrors::advance(int count) {
  if (!running()) return false;
  for (; count > 0 && running(); --count, ++next_step_) {
    if (next_step_ < layout_.floors()) {
      load(next_step_);
      factor_.forward(next_step_, columns_.data(), kDraws);
    } else {
      const int floor = 2 * layout_.floors() - 1 - next_step_;
      factor_.backward(floor, columns_.data(), kDraws);
      finish(floor);
    }
  }
  if (running()) return false;
  error_.swap(new_error_);
  return true;
}

void MassErrors::finish(int floor) {
  for (int u = floor * layout_.own(); u < (floor + 1) * layout_.own(); ++u) {
    const double* row = column(u);
    double sum = 0;
    for (int draw = 0; draw < kDraws; ++draw) sum += row[draw] * row[draw];
    const double error = std::sqrt(sum / kDraws);
    new_error_[static_cast<std::size_t>(u)] = std::isfinite(error) ? error : 0;
  }
}

}  // namespace framewatch::estimator
