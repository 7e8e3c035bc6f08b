#pragma once

#include <vector>

#include "estimator/diagnose/model/plant.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Whether a free run's motion is compared with the axis: the floors' axes; the force axis where a
/// component's motion is prescribed.
bool is_output(const Plant& plant, Eigen::Index axis);

/// The segments with an error of the model beside the sensors' noise: the same on every output axis
/// and in every bin, `share` (NRMSE, as Gap::overall) of the outputs' rms in the band of each
/// segment. Weighted with it, the equations are fitted by the free run at the outputs.
std::vector<RecordSegment> with_model_error(const Plant& plant,
                                            const std::vector<RecordSegment>& segments,
                                            double share);

}  // namespace framewatch::estimator
