#pragma once

#include <deque>
#include <vector>

#include "estimator/identify/window/element_drift.h"
#include "estimator/identify/window/tuned_regression.h"
#include "estimator/identify/window/window_solution.h"

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

}  // namespace framewatch::estimator
