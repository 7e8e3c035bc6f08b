// SPDX-License-Identifier: MIT
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

// The options of a SlidingWindowEstimator in samples: its windows in rows and in blocks of rows,
// and its derivatives. grouped: groups of stories are identified.

namespace framewatch::estimator {

/// A ring of the last deformation sets, addressed by instant.
class MotionRing {
 public:
  MotionRing(const MotionSource& source, int capacity);
  void reset() { next_ = 0; }
  /// Returns the slot of the next instant and counts it as pushed.
  DeformationSet& push() { return slot(next_++); }
  const DeformationSet& at(std::int64_t instant) const {
    return sets_[static_cast<std::size_t>(instant % capacity())];
  }
  /// Return the first instant still held, and the one after the newest.
  std::int64_t begin() const { return next_ > capacity() ? next_ - capacity() : 0; }
  std::int64_t end() const { return next_; }
  /// Returns begin() after `more` further instants.
  std::int64_t begin_after(std::int64_t more) const {
    return std::max<std::int64_t>(next_ + more - capacity(), 0);
  }
  std::int64_t capacity() const { return static_cast<std::int64_t>(sets_.size()); }

  void archive(auto& a) {
    a(sets_);
    a.within(next_, 0, a.kMaxCount);
  }

 private:
  DeformationSet& slot(std::int64_t i) { return sets_[static_cast<std::size_t>(i % capacity())]; }
  std::vector<DeformationSet> sets_;
  std::int64_t next_ = 0;
};

/// The regression under one tuning: the filters of the rows that enter and leave the window, and
/// the window's sums. It advances instant by instant through a motion ring, at its own pace, so
/// that a new tuning can catch up while the old one is in service. Allocates only in the
/// constructor.
class TunedRegression {
 public:
  /// blocks, block_rows, spans: see SlidingGram.
  TunedRegression(std::unique_ptr<RowTuning> tuning, const FloorLayout& layout, int blocks,
                  int block_rows, const std::vector<int>& spans);

  /// Starts anew at an instant of the ring with the present tuning.
  void start(std::int64_t instant);
  std::int64_t next() const { return next_; }
  /// Returns the instants from the start to the first full window of every length.
  int warm_up() const { return tuning_->start_rows() + sums_.longest_rows(); }

  /// Adds instant next(). The window's sum is then ready for the solver, until finish().
  void advance(const MotionRing& ring);
  /// Returns true if finish() will close a block.
  bool closes_block() const { return counting_ && sums_.block_full(); }
  /// Prepares the next instant. Returns true if a block closed.
  bool finish(const MotionRing& ring);

  /// Stops the regression while its tuning changes: rows and sums are invalid, and not part of the
  /// state, until start().
  void rest() { resting_ = true; }
  bool resting() const { return resting_; }

  bool full() const { return counting_ && sums_.full(); }
  /// Returns true if enough blocks have closed for standard errors.
  bool suffices() const { return counting_ && sums_.closed() >= BatchMeans::kFewest; }
  const RowTuning& tuning() const { return *tuning_; }
  /// Returns the tuning. After a change of its parameters, tune every part and call start() before
  /// using the regression.
  RowTuning& tuning() { return *tuning_; }
  SlidingGram& sums() { return sums_; }
  const RowFilter& rows() const { return *entering_; }

  void archive(auto& a) {
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

/// Returns the triple of the variant. advance: in samples.
DerivativeTriple triple_of(const EstimatorOptions& o, bool grouped, double advance);
/// Returns one triple per axis. Acquisition subtracts whole samples of a delay from the stamps; the
/// triple undoes the rest.
std::vector<DerivativeTriple> triples_of(const EstimatorOptions& o, bool grouped,
                                         const std::vector<SensorAxis>& axes);

int rows_of(double seconds, double rate);
SensorClock::duration duration_of(double rows, double rate_hz);
/// Returns the lengths of the other windows in blocks.
std::vector<int> blocks_of(const std::vector<double>& windows_s, double rate_hz, int block_rows);
/// Returns the instants of motion that are kept in addition to the longest window. In the paper's
/// variant it is the settling time of the slowest possible row filter, otherwise the time from
/// which windows are computed late.
int kept_beside(const EstimatorOptions& o, bool grouped);
/// Returns the rows of the longest window, the main window included.
int longest_window(int block_rows, const std::vector<int>& other_blocks);

}  // namespace framewatch::estimator
