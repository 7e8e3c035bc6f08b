#pragma once

#include <vector>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/solve/story_factor.h"
#include "estimator/identify/solve/story_solver.h"

namespace framewatch::estimator {

/// What floors whose masses are off by their tolerance make of the solution of a building with a
/// sensor on every floor: the response of a floor's equations is proportional to its mass. The rms
/// over fixed random errors, carried through the normal equations. Not of groups of stories.
/// docs/equations.md, errors of the model.
class MassErrors {
 public:
  static constexpr int kDraws = 20;

  explicit MassErrors(const FloorLayout& layout);

  /// tolerance: relative standard deviation of a floor's mass. Takes the solver's factor; sums:
  /// those it was factored from, to be kept until the pass is done.
  void begin(StorySolver& solver, const GramShape& shape, const std::vector<double>& sums,
             double tolerance);
  bool running() const { return next_step_ < 2 * layout_.floors(); }
  /// Goes on by at most `count` floors; true when that completed the pass.
  bool advance(int count);
  void cancel() { next_step_ = 2 * layout_.floors(); }
  /// Relative to theta0, internal order, of the last completed pass.
  const std::vector<double>& error() const { return error_; }

  /// shape, sums: those of the pass under way, if any.
  template <typename Archive>
  void archive(Archive& a, const GramShape& shape, const std::vector<double>& sums) {
    a.within(next_step_, 0, 2 * layout_.floors());
    a(factor_, columns_, new_error_);
    a.finite(tolerance_, error_);
    shape_ = &shape;
    sums_ = sums.data();
  }

 private:
  void load(int floor);
  void finish(int floor);
  double* column(int unknown) { return &columns_[static_cast<std::size_t>(unknown) * kDraws]; }

  FloorLayout layout_;
  StoryFactor factor_;
  const GramShape* shape_ = nullptr;
  const double* sums_ = nullptr;
  double tolerance_ = 0;
  int next_step_;
  std::vector<double> columns_;  ///< unknowns x kDraws
  std::vector<double> new_error_, error_;
};

}  // namespace framewatch::estimator
