#pragma once

#include <vector>

#include "estimator/diagnose/model/plant.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Returns true if a free run's motion is compared with the axis: a floor's axis, or the force axis
/// if a component's motion is prescribed.
bool is_output(const Plant& plant, Eigen::Index axis);

/// Returns the segments with an error of the model added to the sensors' noise. The error is equal
/// on every output axis and in every bin: `share` (NRMSE, as Gap::overall) of the outputs' rms in
/// the band of each segment. With these weights a fit minimizes the gap of the free run.
std::vector<RecordSegment> with_model_error(const Plant& plant,
                                            const std::vector<RecordSegment>& segments,
                                            double share);

}  // namespace framewatch::estimator
