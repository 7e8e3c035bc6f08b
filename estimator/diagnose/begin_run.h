#pragma once

#include "estimator/diagnose/fit.h"

namespace framewatch {

/// Where the free run of a fit begins that was driven by measured, noisy motion: a stiff gap comes
/// out softer and wider than it is, and from there its run finds no way. The best of some stiffer
/// and narrower ones. Other fits, and what fits, as they are.
FitResult begin_run(const Fitter& fitter, FitResult fit);

}  // namespace framewatch
