#pragma once

#include "estimator/diagnose/fit/fit.h"

namespace framewatch::estimator {

/// Start values for the free run of a fit that was driven by measured, noisy motion. A stiff
/// mechanical clearance comes out of such a fit softer and wider than it is, and a free run does
/// not converge from there: the best of some stiffer and narrower ones is returned. Fits without a
/// clearance, and those that fit already, are returned unchanged.
FitResult free_run_start(const Fitter& fitter, FitResult fit);

}  // namespace framewatch::estimator
