#pragma once

#include <vector>

#include "estimator/diagnose/fit/fit.h"

namespace framewatch::estimator {

/// Where noise that grows toward low frequencies (RecordSegment::corner_hz) is all that a fit
/// leaves, alike in all equations and smooth over frequency: gives it to the segments, which are
/// those of the fitter, and fits again. Whether it did so.
bool colour_noise(const Fitter& fitter, std::vector<RecordSegment>& segments, FitResult& now);

}  // namespace framewatch::estimator
