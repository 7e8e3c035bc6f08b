#pragma once

#include <vector>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/regressors/regressor_tuning.h"

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

}  // namespace framewatch::estimator
