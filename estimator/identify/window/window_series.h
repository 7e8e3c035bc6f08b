#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "estimator/identify/window/element_drift.h"
#include "estimator/identify/window/tuned_regression.h"
#include "estimator/identify/window/window_solution.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// Windows of other lengths than the main one, of whole blocks, from the same block sums
/// (the spans of SlidingGram). The work is spread over the next block's instants, one window after
/// the other, so an estimate comes up to a block after its window's end.
class OtherWindows {
 public:
  /// blocks: their lengths, the sums' spans.
  OtherWindows(const Structure& structure, const FloorLayout& layout, const ParameterTable& table,
               const EstimatorOptions& options, const std::vector<int>& blocks, int block_rows);

  void restart();
  void mark_late() {
    for (Window& window : windows_) window.estimate.late = true;
  }
  /// WindowSolution::hold() of every window.
  void hold(int unknown, double ratio, double std_error);
  /// The tuning has changed: a solution under way is abandoned.
  void retuned();
  /// A block has closed at `time`, the end of its last instant. `main` fits the sums' own window.
  void block_closed(const SlidingGram& sums, Time time);

  struct Context {
    TunedRegression* regression;
    const WindowSolution* main;
    const std::vector<std::uint8_t>* known;
    WindowSolution::Trust trust;
    bool tuned;
    const ElementDrift* drift;
  };
  /// One instant's share of the work; the estimate of a window that it completed, or null.
  const WindowEstimate* advance(const Context& context);

  /// regression: the active one.
  template <typename Archive>
  void archive(Archive& a, TunedRegression& regression) {
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
  int current_;          ///< window being worked on; count() when there is nothing to do
  bool solved_ = false;  ///< the current one
  int rows_ = 0;         ///< of the current one
  Time end_{};
};

/// The windows along one regression: the main one, solved whenever it is due, and the others,
/// solved as their blocks close. Advances one instant of the motion ring at a time.
class WindowSeries {
 public:
  /// warm: share of the main window in which a floor must have had rows. other_blocks: lengths of
  /// the other windows, the sums' spans.
  WindowSeries(const Structure& structure, const FloorLayout& layout, const ParameterTable& table,
               const EstimatorOptions& options, double warm, const std::vector<int>& other_blocks,
               int block_rows);

  void restart();
  /// The next solutions are of other rows.
  void retuned();
  /// WindowEstimate::late of all other windows.
  void mark_late() { others_.mark_late(); }
  /// WindowSolution::hold() of every window.
  void hold(int unknown, double ratio, double std_error);

  struct Instant {
    const MotionRing* ring;
    WindowSolution::Trust trust;
    bool tuned;  ///< the filters have been found right
    bool due;    ///< the main window is wanted
    const ElementDrift* drift;
    Time window_end;
  };
  struct Done {
    bool block = false;       ///< a block has closed
    bool closed = false;      ///< likewise, of a window that has enough of them
    bool errors_new = false;  ///< the main window's standard errors are those of a new block
    const WindowEstimate* other = nullptr;  ///< of another window, until the next instant
  };
  /// The regression's next instant.
  Done advance(TunedRegression& regression, const Instant& instant);

  const WindowSolution& main() const { return main_; }
  WindowSolution& main() { return main_; }

  template <typename Archive>
  void archive(Archive& a, TunedRegression& regression) {
    main_.archive(a, regression.rows(), regression.sums());
    others_.archive(a, regression);
  }

 private:
  WindowSolution main_;
  OtherWindows others_;
  int steps_per_instant_;  ///< of BatchMeans: done before the next block closes
};

/// Windows that nothing could be said of when they ended, because the filters had not been tuned to
/// the building yet. Once they are, the motion that is still held is gone through again with a
/// regression that has the right filters, a few instants for each new one. Allocates when
/// constructed, never after.
class LateWindows {
 public:
  /// most_blocks: of the longest window. hop_rows: instants between main windows.
  LateWindows(const PipelineConfig& config, const ParameterTable& table, const FloorLayout& layout,
              double warm, const std::vector<int>& other_blocks, int block_rows, int most_blocks,
              int hop_rows);

  /// Starts `regression`, which has been tuned, to give the windows that end from instant `from`
  /// of the ring on and before `until`.
  void begin(TunedRegression& regression, std::int64_t from, std::int64_t until);
  bool running() const { return running_; }
  /// Every window has been given.
  bool complete(const TunedRegression& regression) const { return regression.next() >= until_; }
  /// Abandons what is left; what was given last stays valid.
  void end();
  void hold(int unknown, double ratio, double std_error) {
    series_.hold(unknown, ratio, std_error);
  }

  struct Given {
    const WindowEstimate* main = nullptr;
    const WindowEstimate* other = nullptr;
  };
  /// Its next instant. What is given is valid until the next call.
  Given advance(TunedRegression& regression, const MotionRing& ring,
                const WindowSolution::Trust& trust, Time window_end);

  template <typename Archive>
  void archive(Archive& a, TunedRegression& regression) {
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
