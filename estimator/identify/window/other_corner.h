#pragma once

#include <memory>
#include <vector>

#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/regressors/row_filter.h"
#include "estimator/identify/regressors/row_tuning.h"
#include "estimator/identify/window/tuned_regression.h"
#include "estimator/identify/window/window_solution.h"

namespace framewatch::estimator {

/// The regression once more, with other corners of its oscillator sections, over windows that
/// now and then: where the model is right they give the same numbers. Allocates when
/// constructed, never after.
class OtherCorner {
 public:
  /// tuning: with the other corners. rows: instants of a window.
  OtherCorner(std::unique_ptr<RowTuning> tuning, const Structure& structure,
              const FloorLayout& layout, const ParameterTable& table,
              const EstimatorOptions& options, int rows);

  /// Begins anew, `settle` instants before the first window.
  void restart(int settle);
  /// Other axes or parameters of the rows; restart() follows once tune() has come to its end.
  void retune(const RowTuning& active);
  /// One instant's share of tuning; false: nothing is left to be tuned.
  bool tune();
  int settle_rows(int least) const { return tuning_->settle_rows(least); }

  /// The newest instant of the ring; nothing once full.
  void advance(const MotionRing& ring);
  bool full() const { return count_ >= rows_; }
  /// Of a full window, which the next one follows.
  const WindowSolution& solve(const WindowSolution::Trust& trust);
  /// The sums of the window that was solved last, until restart().
  const std::vector<double>& sums() const { return sum_; }
  const GramShape& shape() const { return shape_; }
  WindowSolution& solution() { return solution_; }

  /// It was tuned anew and has no rows until restart().
  bool resting() const { return resting_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(*tuning_);
    a.within(next_part_, 0, a.kMaxCount);
    a(resting_);
    if (!resting_) a(*rows_filter_);
    a.finite(sum_);
    a.each_within(instants_, 0, a.kMaxCount);
    a.within(count_, 0, rows_);
    a.within(settling_, 0, a.kMaxCount);
    solution_.archive(a, *rows_filter_, *this);
  }
  // Blocks of batch means, of which there are none.
  std::int64_t number_of(const double*) const { return -1; }
  const double* block_of(std::int64_t) const { return nullptr; }

 private:
  std::unique_ptr<RowTuning> tuning_;
  std::unique_ptr<RowFilter> rows_filter_;
  GramShape shape_;
  int floors_, rows_, parts_per_instant_;
  WindowSolution solution_;
  std::vector<double> sum_, zero_;
  std::vector<int> instants_;  ///< by floor
  int count_ = 0, settling_ = 0;
  int next_part_ = 0;
  bool resting_ = true;  ///< until restart(): the filter is of what it was tuned to before
};

}  // namespace framewatch::estimator
