#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/regressors/row_tuning.h"
#include "estimator/identify/solve/story_solver.h"
#include "estimator/identify/solve/uncertainty.h"
#include "estimator/motion/derivative_triple.h"
#include "estimator/motion/sample.h"
#include "estimator/setup/pipeline_config.h"

// What the options of a SlidingWindowEstimator come to in samples: its windows in rows and in
// blocks of rows, and its derivatives. grouped: groups of stories are identified.

namespace framewatch::estimator {

/// A ring of the last deformation sets, addressed by instant.
class MotionRing {
 public:
  MotionRing(const MotionSource& source, int capacity);
  void reset() { next_ = 0; }
  /// The slot for the next instant; counts as pushed.
  DeformationSet& push() { return slot(next_++); }
  const DeformationSet& at(std::int64_t instant) const {
    return sets_[static_cast<std::size_t>(instant % capacity())];
  }
  /// First instant still held, and one past the newest.
  std::int64_t begin() const { return next_ > capacity() ? next_ - capacity() : 0; }
  std::int64_t end() const { return next_; }
  /// begin() once `more` instants have been pushed.
  std::int64_t begin_after(std::int64_t more) const {
    return std::max<std::int64_t>(next_ + more - capacity(), 0);
  }
  std::int64_t capacity() const { return static_cast<std::int64_t>(sets_.size()); }

  template <typename Archive>
  void archive(Archive& a) {
    a(sets_);
    a.within(next_, 0, a.kMaxCount);
  }

 private:
  DeformationSet& slot(std::int64_t i) { return sets_[static_cast<std::size_t>(i % capacity())]; }
  std::vector<DeformationSet> sets_;
  std::int64_t next_ = 0;
};

/// The regression under one tuning: the filters that form the rows entering and leaving the window,
/// and the window's sum of H^T H. Advances instant by instant through a motion ring, at its own
/// pace: a new tuning catches up while the old one is in service. Allocates when constructed, never
/// after.
class TunedRegression {
 public:
  /// blocks, block_rows, spans: see SlidingGram.
  TunedRegression(std::unique_ptr<RowTuning> tuning, const FloorLayout& layout, int blocks,
                  int block_rows, const std::vector<int>& spans);

  /// Starts anew at an instant of the ring, with the tuning as it is now.
  void start(std::int64_t instant);
  std::int64_t next() const { return next_; }
  /// Instants from the start to the first full window of every length.
  int warm_up() const { return tuning_->start_rows() + sums_.longest_rows(); }

  /// Adds instant next(); the window's sum is ready for the solver until finish().
  void advance(const MotionRing& ring);
  /// Whether finish() will close a block.
  bool closes_block() const { return counting_ && sums_.block_full(); }
  /// Prepares the following instant; true when a block closed.
  bool finish(const MotionRing& ring);

  /// The tuning changes: rows and sums are of no use, and no state, until start().
  void rest() { resting_ = true; }
  bool resting() const { return resting_; }

  bool full() const { return counting_ && sums_.full(); }
  /// Blocks have closed that are enough for standard errors.
  bool suffices() const { return counting_ && sums_.closed() >= BatchMeans::kFewest; }
  const RowTuning& tuning() const { return *tuning_; }
  /// After other parameters every part must be tuned, and start() called, before the regression is
  /// used again.
  RowTuning& tuning() { return *tuning_; }
  SlidingGram& sums() { return sums_; }
  const RowFilter& rows() const { return *entering_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(*tuning_, resting_);
    if (resting_) return;
    a(*entering_, *delayed_, sums_, counting_);
    for (std::int64_t* number : {&next_, &delayed_next_, &counted_from_})
      a.within(*number, 0, a.kMaxCount);
  }

 private:
  std::unique_ptr<RowTuning> tuning_;
  FloorLayout layout_;
  std::unique_ptr<RowFilter> entering_, delayed_;
  SlidingGram sums_;
  std::int64_t next_ = 0, delayed_next_ = 0, counted_from_ = 0;
  bool counting_ = false, resting_ = false;
};

/// advance: in samples.
DerivativeTriple triple_of(const EstimatorOptions& o, bool grouped, double advance);
/// By axis. Acquisition subtracts whole samples of a delay from the stamps; the triple undoes the
/// rest.
std::vector<DerivativeTriple> triples_of(const EstimatorOptions& o, bool grouped,
                                         const std::vector<SensorAxis>& axes);

int rows_of(double seconds, double rate);
SensorClock::duration duration_of(double rows, double rate_hz);
/// Of the other windows.
std::vector<int> blocks_of(const std::vector<double>& windows_s, double rate_hz, int block_rows);
/// Instants of motion that are kept beside the longest window: what the slowest possible row filter
/// of the paper's variant needs to settle; of the others, what windows are looked at again from.
int kept_beside(const EstimatorOptions& o, bool grouped);
/// In rows, the main window included.
int longest_window(int block_rows, const std::vector<int>& other_blocks);

}  // namespace framewatch::estimator
