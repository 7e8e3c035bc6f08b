#pragma once

#include <cstdint>

#include "estimator/identify/row_chain.h"
#include "estimator/identify/row_tuning.h"
#include "estimator/identify/story_solver.h"
#include "estimator/identify/uncertainty.h"
#include "estimator/identify/window_sums.h"

namespace framewatch {

/// A ring of the last deformation sets, addressed by instant.
class MotionRing {
 public:
  MotionRing(const Deformations& deformations, int capacity);
  void reset() { next_ = 0; }
  /// The slot for the next instant; counts as pushed.
  DeformationSet& push() { return slot(next_++); }
  const DeformationSet& at(std::int64_t instant) const {
    return sets_[static_cast<std::size_t>(instant % capacity())];
  }
  /// First instant still held, and one past the newest.
  std::int64_t begin() const { return next_ > capacity() ? next_ - capacity() : 0; }
  std::int64_t end() const { return next_; }
  std::int64_t capacity() const { return static_cast<std::int64_t>(sets_.size()); }

  template <typename Archive>
  void archive(Archive& a) {
    a(sets_, next_);
  }

 private:
  DeformationSet& slot(std::int64_t i) { return sets_[static_cast<std::size_t>(i % capacity())]; }
  std::vector<DeformationSet> sets_;
  std::int64_t next_ = 0;
};

/// One tuning at work: both row chains, the window's sums and the solver. Advances instant by
/// instant through a motion ring, at its own pace: a new tuning catches up while the old one
/// serves. Allocates when constructed, never after.
class Machine {
 public:
  /// blocks, block_rows, spans: see WindowSums. least_settle: see RowTuning::settle_rows.
  Machine(const RowTuning& tuning, const FloorLayout& layout, int blocks, int block_rows,
          const std::vector<int>& spans, int least_settle);

  /// Gives the machine another design. Every floor of it must be tuned, and start() called, before
  /// it is used again.
  void set_design(const Eigen::VectorXd& theta0, const std::vector<double>& noise_density) {
    tuning_.set_design(theta0, noise_density);
  }
  void tune(int floor) { tuning_.tune(floor); }

  /// Starts anew at an instant of the ring, on the tuning as it is now.
  void start(std::int64_t instant);
  std::int64_t next() const { return next_; }
  /// Instants from the start to the first full window of every length.
  int warm_up() const { return tuning_.settle_rows(least_settle_) + sums_.longest_rows(); }

  /// Takes instant next() in; the window's sum is ready for factor() until finish().
  void advance(const MotionRing& ring);
  /// Whether finish() will close a block.
  bool closes_block() const { return counting_ && sums_.block_full(); }
  /// Prepares the following instant; true when a block closed.
  bool finish(const MotionRing& ring);

  bool full() const { return counting_ && sums_.full(); }
  const RowTuning& tuning() const { return tuning_; }
  RowTuning& tuning() { return tuning_; }
  WindowSums& sums() { return sums_; }
  const RowChain& rows() const { return entering_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(tuning_, entering_, delayed_, sums_, next_, delayed_next_, counted_from_, counting_);
  }

 private:
  RowTuning tuning_;
  FloorLayout layout_;
  int least_settle_;
  RowChain entering_, delayed_;
  WindowSums sums_;
  std::int64_t next_ = 0, delayed_next_ = 0, counted_from_ = 0;
  bool counting_ = false;
};

}  // namespace framewatch
