#pragma once

#include <vector>

#include "estimator/diagnose/locate/localise.h"

namespace framewatch::estimator {

/// The colour of the noise (RecordSegment::corner_hz) by what is left where anything may act at a
/// place: that of most of the frequencies, the others have something else that is missing. Sets it
/// in the segments, which are those of the fitter; whether it changed.
bool colour_beside(const Fitter& fitter, std::vector<RecordSegment>& segments,
                   const Localisation& place);

}  // namespace framewatch::estimator
