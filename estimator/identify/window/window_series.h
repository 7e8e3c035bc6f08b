#pragma once

#include <cstdint>
#include <vector>

#include "estimator/identify/window/element_drift.h"
#include "estimator/identify/window/other_windows.h"
#include "estimator/identify/window/tuned_regression.h"
#include "estimator/identify/window/window_solution.h"

namespace framewatch::estimator {

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

}  // namespace framewatch::estimator
