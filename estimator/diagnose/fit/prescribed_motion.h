#pragma once

#include <optional>

#include <Eigen/Core>

#include "estimator/diagnose/model/plant.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Deformation (m) of a component whose motion is prescribed and measured as displacement, and its
/// rate (m/s).
struct PrescribedMotion {
  Eigen::VectorXd d, v;
};

/// `ratio` instants a sample: what was measured below the upper end of the band, drift and slow
/// motion below the band included, since a law remembers them. sense: over the axes, their motion
/// to the deformation's. Empty where the motion is not prescribed or the deformation is not made of
/// displacements alone.
std::optional<PrescribedMotion> prescribed_motion(const Plant& plant, const RecordSegment& segment,
                                                  const Eigen::RowVectorXd& sense, int ratio);

}  // namespace framewatch::estimator
