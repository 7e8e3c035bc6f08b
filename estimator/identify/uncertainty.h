#pragma once

#include <vector>

#include "estimator/identify/floor_layout.h"
#include "estimator/identify/story_solver.h"
#include "estimator/identify/window_sums.h"

namespace framewatch {

/// Standard deviation of every relative unknown by batch means: the scores of the window's blocks,
/// which are nearly independent although the residuals inside a block are not, carried through the
/// factored normal equations. docs/equations.md, batch means.
class BatchMeans {
 public:
  BatchMeans(const FloorLayout& layout, int blocks);

  /// Valid right after maintain() closed the block whose window `solver` factored.
  void compute(const WindowSums& sums, const StorySolver& solver);
  /// Internal order, relative to the design.
  const std::vector<double>& std_error() const { return std_error_; }

 private:
  FloorLayout layout_;
  int blocks_;
  std::vector<double> scores_;  ///< unknowns x blocks
  std::vector<double> std_error_;
};

}  // namespace framewatch
