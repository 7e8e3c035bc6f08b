#pragma once

#include <vector>

#include "estimator/identify/floor_layout.h"
#include "estimator/identify/story_solver.h"
#include "estimator/identify/window_sums.h"

namespace framewatch {

/// Standard deviation of every relative unknown: spread, by batch means (the scores of the window's
/// blocks, nearly independent although the residuals inside a block are not, carried through the
/// factored normal equations), and pull: how far prior and noise can drag the solution toward a
/// design that is wrong by its usual tolerance. docs/equations.md, batch means.
class BatchMeans {
 public:
  /// tolerance: how far the design may be off, relative, per unknown.
  BatchMeans(const FloorLayout& layout, int blocks, const std::vector<double>& tolerance);

  /// Valid right after maintain() closed the block whose window `solver` factored.
  /// noise_level: variance of the noise over the configured one.
  void compute(const WindowSums& sums, const StorySolver& solver, const std::vector<double>& prior,
               const NoiseShare& noise, double noise_level);
  /// The unknown is from now on relative to another design: times `factor`.
  void rescale(int unknown, double factor) {
    std_error_[static_cast<std::size_t>(unknown)] *= factor;
  }
  /// Internal order, relative to the design.
  const std::vector<double>& std_error() const { return std_error_; }

 private:
  FloorLayout layout_;
  int blocks_;
  void add_block_scores(const WindowSums& sums, const std::vector<double>& solution);
  void add_pulls(const std::vector<double>& prior, const NoiseShare& noise, double noise_level);

  int columns_;
  std::vector<double> columns_values_;  ///< unknowns x (blocks, then pulls)
  std::vector<double> tolerance_, wrong_, pulled_;
  std::vector<double> std_error_;
};

}  // namespace framewatch
