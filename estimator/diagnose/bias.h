#pragma once

#include <optional>
#include <vector>

#include "estimator/diagnose/plant.h"
#include "estimator/diagnose/stretch.h"

namespace framewatch {

/// A reading that rises or falls: ramp max(t - from, 0).
struct Ramp {
  double slope = 0;   ///< m/s^2 per s
  double from_s = 0;  ///< s
  double rms = 0;     ///< of the ramp about its mean over the stretch, m/s^2
};

/// The ramp of an axis whose slow reading wanders as no other's does; the building's own motion and
/// noise are what its neighbours show. Empty when there is none.
std::optional<Ramp> find_ramp(const Plant& plant, const Stretch& stretch, Eigen::Index axis);

/// The stretch without the ramp.
Stretch without_ramp(const Stretch& stretch, Eigen::Index axis, const Ramp& ramp);

}  // namespace framewatch
