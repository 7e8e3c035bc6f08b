#pragma once

#include <vector>

#include "estimator/identify/elements/floor_layout.h"

namespace framewatch::estimator {

/// Fixed random errors of a design, each as large as its tolerance (design_tolerance): how much
/// prior and noise bias the solution toward a design with such errors is part of the standard
/// error. docs/equations.md, batch means.
class PerturbedDesigns {
 public:
  static constexpr int kCount = 20;

  explicit PerturbedDesigns(const FloorLayout& layout);

  /// Relative error of every front unknown of a floor, row-major, unknowns x kCount.
  const double* floor(int floor) const {
    return &error_[static_cast<std::size_t>(floor * own_ * kCount)];
  }

 private:
  int own_;
  std::vector<double> error_;
};

}  // namespace framewatch::estimator
