#pragma once

#include <array>
#include <vector>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/solve/noise_compensation.h"
#include "estimator/identify/solve/story_factor.h"

namespace framewatch::estimator {

/// Solves the window's normal equations story by story: they are block tridiagonal, so each story's
/// unknowns are eliminated from its own front and only 2 frames + 1 columns are passed on.
/// Unknowns are relative: theta = theta0 * x. docs/equations.md, story-ordered solution.
class StorySolver {
 public:
  explicit StorySolver(const FloorLayout& layout);

  /// prior: precision of every unknown about `centre`, in the rows' units, internal order; 0 =
  /// none.
  void factor(const WindowParts& sums, const std::vector<double>& prior,
              const std::vector<double>& centre, const NoiseCompensation& noise);

  /// Unknowns in internal order (floor by floor); unusable ones are 1 (theta0).
  const std::vector<double>& solution() const { return x_; }
  bool usable(int unknown) const { return usable_[static_cast<std::size_t>(unknown)] != 0; }
  /// Diagonal of the data's normal matrix, before the prior.
  const std::vector<double>& information() const { return information_; }
  /// Sum of squares of the response, and of what the solution leaves of it.
  double response_energy() const { return response_energy_; }
  double residual_energy() const { return residual_energy_; }

  /// Gives the factor away for another one, which the next factor() overwrites.
  void swap_factor(StoryFactor& other) { factor_.swap(other); }

  template <typename Archive>
  void archive(Archive& a) {
    a(x_, information_, usable_, response_energy_, residual_energy_);
  }

 private:
  void gather_information(const WindowParts& sums, int floor);

  FloorLayout layout_;
  StoryFactor factor_;
  std::array<std::vector<double>, 2> front_;  ///< of this floor and of the one below
  std::vector<double> pivot_floor_;
  std::vector<double> x_, information_;
  std::vector<unsigned char> usable_;
  double response_energy_ = 0, residual_energy_ = 0;
};

}  // namespace framewatch::estimator
