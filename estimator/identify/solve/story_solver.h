#pragma once

#include <array>
#include <vector>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/regressors/regressor_tuning.h"
#include "estimator/identify/solve/noise_compensation.h"

namespace framewatch::estimator {

/// Cholesky factor U of a story-ordered normal matrix N = U^T U: per floor, `own` rows over the
/// floor's own unknowns and the next story's frames. Everything is done floor by floor so that a
/// caller may spread it over instants. An unknown the factorisation gave up has a zero row: it is
/// held fixed.
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

  template <typename Archive>
  void archive(Archive& a) {
    a(values_);
  }

  /// One floor of N X = right, in place; right: unknowns x columns, row-major, columns a multiple
  /// of kLane. Forward from the lowest floor to the highest, then backward down again.
  void forward(int floor, double* right, int columns) const;
  void backward(int floor, double* right, int columns) const;

 private:
  FloorLayout layout_;
  std::size_t stride_;
  std::vector<double> values_;
};

/// Diagonal of N^-1 from its factor, from the highest floor down to the lowest.
class InverseDiagonal {
 public:
  explicit InverseDiagonal(const FloorLayout& layout);

  /// Writes the floor's own entries. Floors in descending order, starting at the highest.
  void step(const StoryFactor& factor, int floor, double* diagonal);

  template <typename Archive>
  void archive(Archive& a) {
    a(inverse_, coupled_, middle_, transposed_);
  }

 private:
  FloorLayout layout_;
  int columns_;
  std::vector<double> inverse_;  ///< own x columns_: N^-1 of the floor above, then here
  std::vector<double> coupled_, middle_, transposed_;
};

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
