// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

namespace framewatch::estimator {

/// The clock of the sensors, to which the nodes are synchronized. The estimator uses no other
/// clock.
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

/// Returns the seconds since the epoch of the sensor clock.
inline double seconds_of(Time time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

inline double seconds_of(SensorClock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// The raw value of one axis at one instant, m/s^2 before calibration.
struct AccelSample {
  Time time;
  int axis = 0;  ///< index into the sensor axes
  double accel = 0;
};

/// The calibrated values of all axes at one instant of the common grid, m/s^2; NaN for an axis
/// without a value.
struct SampleSet {
  Time time;
  std::int64_t index = 0;  ///< number of the instant on the common grid
  std::vector<double> accel;

  /// Copies a set of as many axes without allocating.
  void copy(const SampleSet& other) {
    time = other.time;
    index = other.index;
    std::copy(other.accel.begin(), other.accel.end(), accel.begin());
  }
  /// Archives the state, as every archive() does: estimator/state/archive.h.
  void archive(auto& a) {
    a(time);
    a.within(index, 0, a.kMaxCount);
    a(accel);
  }
};

}  // namespace framewatch::estimator
