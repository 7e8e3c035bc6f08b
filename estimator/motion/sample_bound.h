#pragma once

#include <cmath>

#include "estimator/structure/sensors.h"

namespace framewatch::estimator {

/// No building, table or impact on them has accelerations beyond this, m/s^2 either way: 20 g.
inline constexpr double kMaxAccel = 200;
/// No sensor resolves this, m/s^2: a smaller number than it that is not 0 is no reading, but
/// another kind of number taken for one.
inline constexpr double kMinAccel = 1e-30;

/// The readings that a channel can have, m/s^2 of scale times raw. A sample outside is no
/// measurement, whatever it is: it never enters a filter.
struct SampleBound {
  double least, most;

  /// False for what is no number.
  bool holds(double scaled) const {
    return scaled >= least && scaled <= most && (std::abs(scaled) >= kMinAccel || scaled == 0);
  }
};

/// With a range, kBeyondRange of it on either side of 0: what is between the two is clipped
/// (AxisGuard). Without one, kMaxAccel on either side of the offset.
inline SampleBound sample_bound(const SensorAxis& axis) {
  constexpr double kBeyondRange = 1.25, kMaxForce_n = 1e12;
  if (axis.range > 0) return {-kBeyondRange * axis.range, kBeyondRange * axis.range};
  if (axis.is_force) return {-kMaxForce_n, kMaxForce_n};
  return {axis.offset - kMaxAccel, axis.offset + kMaxAccel};
}

}  // namespace framewatch::estimator
