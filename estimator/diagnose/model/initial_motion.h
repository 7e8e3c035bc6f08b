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

/// As measured: readings integrated within the segment's band, a quarter of the lead after its
/// begin, so that a record that begins in motion need not be simulated from rest. Empty without a
/// lead, and where it begins at rest: then a run from rest is exact.
std::optional<InitialMotion> initial_motion(const Plant& plant, const Model& model,
                                            const RecordSegment& segment);

}  // namespace framewatch::estimator
