#pragma once

#include "estimator/diagnose/fit.h"

namespace framewatch {

/// Where the free run of a fit whose last effect is a gap begins; other fits, and what fits, as
/// they are. A stiff gap that was driven by measured, noisy motion comes out softer and wider than
/// it is, and from there its run finds no way: the best of some stiffer and narrower ones.
FitResult begin_gap(const Fitter& fitter, FitResult fit);

}  // namespace framewatch
