// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "estimator/identify/window/element_drift.h"
#include "estimator/identify/window/tuned_regression.h"
#include "estimator/identify/window/window_solution.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// Windows of other lengths than the main one, in whole blocks of the same block sums (the spans of
/// SlidingGram). The work is spread over the instants of the next block, one window after the
/// other. So an estimate comes up to a block after the end of its window.
class OtherWindows {
 public:
  /// blocks: lengths of the windows, which are the spans of the sums.
  OtherWindows(const Structure& structure, const FloorLayout& layout, const ParameterTable& table,
               const EstimatorOptions& options, const std::vector<int>& blocks, int block_rows);

  void restart();
  void mark_late() {
    for (Window& window : windows_) window.estimate.late = true;
  }
  /// Calls WindowSolution::hold() for every window.
  void hold(int unknown, double ratio, double std_error);
  /// Abandons a solution in progress, because the tuning has changed.
  void retuned();
  /// Takes a block that closed at `time`, the end of its last instant.
  void block_closed(const SlidingGram& sums, Time time);

  struct Context {
    TunedRegression* regression;
    const WindowSolution* main;
    const std::vector<std::uint8_t>* known;
    WindowSolution::Trust trust;
    bool tuned;
    const ElementDrift* drift;
  };
  /// Does one instant's share of the work. Returns the estimate of a window that it completed, or
  /// nullptr.
  const WindowEstimate* advance(const Context& context);

  /// regression: the active one.
  void archive(auto& a, TunedRegression& regression) {
    for (Window& window : windows_) {
      window.solution.archive(a, regression.rows(), regression.sums());
      a(window.estimate);
    }
    a.within(current_, 0, count());
    a.within(rows_, 0, a.kMaxCount);
    a(solved_, end_);
  }

 private:
  int count() const { return static_cast<int>(windows_.size()); }
  void next(const SlidingGram& sums);
  const WindowEstimate* give(const Context& context);

  struct Window {
    WindowSolution solution;
    WindowEstimate estimate;
  };
  std::deque<Window> windows_;
  double rate_hz_;
  int steps_per_instant_ = 1;
  int current_;          ///< window in progress; count() if there is nothing to do
  bool solved_ = false;  ///< the window in progress is solved
  int rows_ = 0;         ///< rows of the window in progress
  Time end_{};
};

/// The windows of one regression: the main one, solved when it is due, and the others, solved when
/// their blocks close. Advances by one instant of the motion ring at a time.
class WindowSeries {
 public:
  /// warm: share of the main window in which a floor must have had rows. other_blocks: lengths of
  /// the other windows, which are the spans of the sums.
  WindowSeries(const Structure& structure, const FloorLayout& layout, const ParameterTable& table,
               const EstimatorOptions& options, double warm, const std::vector<int>& other_blocks,
               int block_rows);

  void restart();
  /// Takes note that the next solutions come from other rows.
  void retuned();
  /// Sets WindowEstimate::late in all other windows.
  void mark_late() { others_.mark_late(); }
  /// Calls WindowSolution::hold() for every window.
  void hold(int unknown, double ratio, double std_error);

  struct Instant {
    const MotionRing* ring;
    WindowSolution::Trust trust;
    bool tuned;  ///< the filters have been found to match
    bool due;    ///< the main window is requested
    const ElementDrift* drift;
    Time window_end;
  };
  struct Done {
    bool block = false;       ///< a block has closed
    bool closed = false;      ///< a block has closed and the window has enough of them
    bool errors_new = false;  ///< the main window's standard errors come from a new block
    const WindowEstimate* other = nullptr;  ///< valid until the next instant
  };
  /// Advances the regression by its next instant.
  Done advance(TunedRegression& regression, const Instant& instant);

  const WindowSolution& main() const { return main_; }
  WindowSolution& main() { return main_; }

  void archive(auto& a, TunedRegression& regression) {
    main_.archive(a, regression.rows(), regression.sums());
    others_.archive(a, regression);
  }

 private:
  WindowSolution main_;
  OtherWindows others_;
  int steps_per_instant_;  ///< steps of BatchMeans, so that a pass ends before the next block
                           ///< closes
};

/// Windows that could not be solved when they ended, because the filters were not tuned to the
/// building. Later the motion that is still held is processed again with a tuned regression, a few
/// instants for each new one. Allocates only in the constructor.
class LateWindows {
 public:
  /// most_blocks: blocks in the longest window. hop_rows: instants between main windows.
  LateWindows(const PipelineConfig& config, const ParameterTable& table, const FloorLayout& layout,
              double warm, const std::vector<int>& other_blocks, int block_rows, int most_blocks,
              int hop_rows);

  /// Starts the tuned `regression` on the windows that end from instant `from` of the ring on and
  /// before `until`.
  void begin(TunedRegression& regression, std::int64_t from, std::int64_t until);
  bool running() const { return running_; }
  /// Returns true if every window has been computed.
  bool complete(const TunedRegression& regression) const { return regression.next() >= until_; }
  /// Abandons the remaining windows. The last result stays valid.
  void end();
  void hold(int unknown, double ratio, double std_error) {
    series_.hold(unknown, ratio, std_error);
  }

  struct Given {
    const WindowEstimate* main = nullptr;
    const WindowEstimate* other = nullptr;
  };
  /// Advances by the next instant. The result is valid until the next call.
  Given advance(TunedRegression& regression, const MotionRing& ring,
                const WindowSolution::Trust& trust, Time window_end);

  void archive(auto& a, TunedRegression& regression) {
    a(running_);
    a.within(estimate_.sequence, -1, a.kMaxCount);
    if (!running_) return;
    if (regression.resting()) a.refuse();
    a(drift_, estimate_);
    a.within(until_, 0, a.kMaxCount);
    a.within(since_hop_, 0, hop_rows_);
    series_.archive(a, regression);
  }

 private:
  double rate_hz_;
  int hop_rows_, blocks_;
  WindowSeries series_;
  ElementDrift drift_;
  WindowEstimate estimate_;
  std::int64_t until_ = 0;
  int since_hop_ = 0;
  bool running_ = false;
};

}  // namespace framewatch::estimator
