#pragma once

#include <vector>

#include "estimator/diagnose/locate/localise.h"

namespace framewatch::estimator {

/// Estimates the corner frequency of the noise (RecordSegment::corner_hz) from the residual with
/// arbitrary signals at a place. Uses most of the cells; in the others some effect is still
/// missing. Sets it in `segments`, which are those of the fitter. Returns true if it changed.
bool colour_beside(const Fitter& fitter, std::vector<RecordSegment>& segments,
                   const Localisation& place);

}  // namespace framewatch::estimator
