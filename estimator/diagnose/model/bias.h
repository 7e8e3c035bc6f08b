// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "estimator/diagnose/model/plant.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Drift of an axis' bias. It adds slope * max(t - from_s, 0) to the reading, or another slow curve
/// that this ramp approximates.
struct Ramp {
  double slope = 0;   ///< m/s^2 per s
  double from_s = 0;  ///< s
  double rms = 0;     ///< of the drift about its mean over the segment, m/s^2
  /// The drift at every instant of the segment, m/s^2; empty: the ramp itself.
  Eigen::VectorXd curve = {};
};

/// Returns the drift of an axis, or nullopt. An axis drifts if its mean reading drifts far more
/// than those of the other axes, which share the building's motion. The drift is a curve of cosines
/// slower than the band if the curve follows the mean reading far better than a ramp.
std::optional<Ramp> find_ramp(const Plant& plant, const RecordSegment& segment, Eigen::Index axis);

/// Returns the segment with the ramp subtracted from one axis.
RecordSegment without_ramp(const RecordSegment& segment, Eigen::Index axis, const Ramp& ramp);

}  // namespace framewatch::estimator
