// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/regressors/regressor_tuning.h"
#include "estimator/identify/solve/noise_compensation.h"

namespace framewatch::estimator {

/// Cholesky factor U of a story-ordered normal matrix N = U^T U. Each floor has `own` rows over its
/// own unknowns and the next story's frames. Every operation works on one floor, so that a caller
/// can spread the work over instants. An unknown whose pivot failed has a zero row: it is held
/// fixed.
class StoryFactor {
 public:
  explicit StoryFactor(const FloorLayout& layout)
      : layout_(layout),
        stride_(static_cast<std::size_t>(layout.own() * padded(layout.most_front()))),
        values_(stride_ * static_cast<std::size_t>(layout.floors()), 0.0) {}

  void swap(StoryFactor& other) { values_.swap(other.values_); }
  double* rows(int floor) { return &values_[static_cast<std::size_t>(floor) * stride_]; }
  const double* rows(int floor) const {
    return &values_[static_cast<std::size_t>(floor) * stride_];
  }
  int row_stride(int floor) const { return padded(layout_.front(floor)); }

  void archive(auto& a) { a(values_); }

  /// Solve one floor of N X = right in place. right: unknowns x columns, row-major, columns a
  /// multiple of kLane. Call forward() from the lowest floor to the highest, then backward() down
  /// again.
  void forward(int floor, double* right, int columns) const;
  void backward(int floor, double* right, int columns) const;

 private:
  FloorLayout layout_;
  std::size_t stride_;
  std::vector<double> values_;
};

/// Computes the diagonal of N^-1 from the factor, from the highest floor down to the lowest.
class InverseDiagonal {
 public:
  explicit InverseDiagonal(const FloorLayout& layout);

  /// Writes the entries of a floor's own unknowns. Call it for floors in descending order from the
  /// highest.
  void step(const StoryFactor& factor, int floor, double* diagonal);

  void archive(auto& a) { a(inverse_, coupled_, middle_, transposed_); }

 private:
  FloorLayout layout_;
  int columns_;
  std::vector<double> inverse_;  ///< own x columns_: N^-1 of the floor above, then of this one
  std::vector<double> coupled_, middle_, transposed_;
};

/// Solves the window's normal equations story by story. They are block tridiagonal, so each story's
/// unknowns are eliminated from its own front, and only 2 frames + 1 columns are passed on.
/// Unknowns are relative: theta = theta0 * x. docs/equations.md, story-ordered solution.
class StorySolver {
 public:
  explicit StorySolver(const FloorLayout& layout);

  /// Factors and solves. prior: precision of every unknown about `centre`, in the rows' units,
  /// internal order; 0: no prior.
  void factor(const WindowParts& sums, const std::vector<double>& prior,
              const std::vector<double>& centre, const NoiseCompensation& noise);

  /// Returns the unknowns in internal order (floor by floor). Unusable ones are 1 (theta0).
  const std::vector<double>& solution() const { return x_; }
  bool usable(int unknown) const { return usable_[static_cast<std::size_t>(unknown)] != 0; }
  /// Returns the diagonal of the data's normal matrix, before the prior is added.
  const std::vector<double>& information() const { return information_; }
  /// Return the sum of squares of the response, and of the part that the solution leaves.
  double response_energy() const { return response_energy_; }
  double residual_energy() const { return residual_energy_; }

  /// Exchanges the factor for another one, which the next factor() overwrites.
  void swap_factor(StoryFactor& other) { factor_.swap(other); }

  void archive(auto& a) { a(x_, information_, usable_, response_energy_, residual_energy_); }

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
