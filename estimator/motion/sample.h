#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

namespace framewatch::estimator {

/// The sensors' clock: whatever the nodes are synchronised to. The estimator knows no other.
struct SensorClock {
  using duration = std::chrono::microseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<SensorClock>;
  static constexpr bool is_steady = false;
};
using Time = SensorClock::time_point;

inline std::int64_t to_microseconds(Time t) {
  return t.time_since_epoch().count();
}
inline Time from_microseconds(std::int64_t us) {
  return Time(SensorClock::duration(us));
}

/// One axis at one instant: the sensor's raw value, m/s^2 before calibration.
struct AccelSample {
  Time time;
  int axis = 0;  ///< index into the sensor axes
  double accel = 0;
};

/// All axes at one instant of the common grid, calibrated, m/s^2; NaN where an axis has no value.
struct SampleSet {
  Time time;
  std::int64_t index = 0;  ///< instant number on the common grid
  std::vector<double> accel;

  /// State, here and in every other archive(): estimator/state/archive.h.
  template <typename Archive>
  void archive(Archive& a) {
    a(time);
    a.within(index, 0, a.kMaxCount);
    a(accel);
  }
};

}  // namespace framewatch::estimator
