#pragma once

#include <optional>

#include <Eigen/Core>

#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Motion of the coordinates relative to the ground at one sample of a segment's lead.
struct InitialMotion {
  Eigen::Index sample = 0;                 ///< of the lead
  Eigen::VectorXd displacement, velocity;  ///< m, m/s
};

/// Returns the measured motion a quarter into the lead, so that a record that begins in motion need
/// not be simulated from rest. Integrates the readings within the segment's band. Returns nullopt
/// if there is no lead, or if the lead begins at rest: a run from rest is then exact.
std::optional<InitialMotion> initial_motion(const Plant& plant, const Model& model,
                                            const RecordSegment& segment);

}  // namespace framewatch::estimator
