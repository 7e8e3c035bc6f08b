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
  using duration = std::chrono::microseconds;               ///< resolution of the clock
  using rep = duration::rep;                                ///< type of a number of ticks
  using period = duration::period;                          ///< length of a tick
  using time_point = std::chrono::time_point<SensorClock>;  ///< an instant
  static constexpr bool is_steady = false;                  ///< a synchronization may set it back
};
/// An instant of the sensor clock.
using Time = SensorClock::time_point;

/// Returns the microseconds since the epoch of the sensor clock.
inline std::int64_t to_microseconds(Time t) {
  return t.time_since_epoch().count();
}
/// Returns the instant `us` microseconds after the epoch of the sensor clock.
inline Time from_microseconds(std::int64_t us) {
  return Time(SensorClock::duration(us));
}

/// Returns the seconds since the epoch of the sensor clock.
inline double seconds_of(Time time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

/// Returns a duration in seconds.
inline double seconds_of(SensorClock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// The raw value of one axis at one instant, m/s^2 before calibration.
struct AccelSample {
  Time time;         ///< instant of the measurement
  int axis = 0;      ///< index into the sensor axes
  double accel = 0;  ///< m/s^2 before calibration; N for an axis that measures a force
};

/// The calibrated values of all axes at one instant of the common grid, m/s^2; NaN for an axis
/// without a value.
struct SampleSet {
  Time time;                  ///< of the instant
  std::int64_t index = 0;     ///< number of the instant on the common grid
  std::vector<double> accel;  ///< m/s^2, by configured axis

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
