#pragma once

#include <vector>

#include "estimator/identify/floor_layout.h"

namespace framewatch {

/// Designs that are off by their usual tolerance (design_tolerance) in fixed random directions: how
/// far prior and noise drag the solution toward them is part of its error. docs/equations.md,
/// batch means.
class WrongDesigns {
 public:
  static constexpr int kCount = 20;

  explicit WrongDesigns(const FloorLayout& layout);

  /// Relative error of every front unknown of a floor, row-major, unknowns x kCount.
  const double* floor(int floor) const {
    return &error_[static_cast<std::size_t>(floor * own_ * kCount)];
  }

 private:
  int own_;
  std::vector<double> error_;
};

}  // namespace framewatch
