#pragma once

#include <cstdint>

#include "estimator/watch/gap.h"
#include "estimator/watch/watch.h"

namespace framewatch {

/// News of a lasting gap between simulation and measurement.
struct GapNews {
  std::int64_t id = 0;  ///< sensor time it was raised, microseconds; the same when it is cleared
  AlarmState state = AlarmState::raised;
  Time found, since;  ///< end and start of windows
  double excess = 0;  ///< sqrt(nrmse^2 - floor^2)
  int worst_axis = -1;

  template <typename Archive>
  void archive(Archive& a) {
    a(id, state, found, since, excess, worst_axis);
  }
};

/// Decides when a gap lasts. Windows in which noise alone would be as large as a gap say nothing.
class GapAlarm {
 public:
  explicit GapAlarm(const GapOptions& options) : options_(options) {}

  /// One window per second. Null when there is no news; valid until the next call.
  const GapNews* push(const GapWindow& window);
  bool raised() const { return raised_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(raised_, seconds_, since_, news_);
  }

 private:
  GapOptions options_;
  bool raised_ = false;
  int seconds_ = 0;  ///< that the windows have been otherwise than the alarm says
  Time since_{};
  GapNews news_;
};

}  // namespace framewatch
