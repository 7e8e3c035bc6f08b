#pragma once

#include <cstdint>
#include <vector>

#include "estimator/identify/window/window_series.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

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
