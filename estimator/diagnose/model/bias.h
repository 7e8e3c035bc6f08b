#pragma once

#include <optional>
#include <vector>

#include "estimator/diagnose/model/plant.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Drift of an axis' bias: slope * max(t - from_s, 0) is added to the reading, or another slow
/// curve, which the ramp comes nearest to.
struct Ramp {
  double slope = 0;   ///< m/s^2 per s
  double from_s = 0;  ///< s
  double rms = 0;     ///< of the drift about its mean over the segment, m/s^2
  /// The drift at every instant of the segment, m/s^2; empty: the ramp itself.
  Eigen::VectorXd curve = {};
};

/// The drift of an axis; empty when there is none. An axis has one if its mean reading drifts far
/// more than those of the other axes, which share the building's motion. A curve is one of cosines
/// slower than the band, where it follows the mean reading far better than a ramp.
std::optional<Ramp> find_ramp(const Plant& plant, const RecordSegment& segment, Eigen::Index axis);

/// The segment with the ramp subtracted from one axis.
RecordSegment without_ramp(const RecordSegment& segment, Eigen::Index axis, const Ramp& ramp);

}  // namespace framewatch::estimator
