#pragma once

#include "estimator/diagnose/fit/fit.h"

namespace framewatch::estimator {

/// Start values for the free run of a fit that was driven by measured, noisy motion. A stiff
/// mechanical clearance comes out of such a fit softer and wider than it is, and a free run does
/// not converge from there: the best of some stiffer and narrower ones is returned. Fits without a
/// clearance, and those that fit already, are returned unchanged.
FitResult free_run_start(const Fitter& fitter, FitResult fit);

/// Start values for the free run of friction that sticks so long that measured, noisy motion says
/// little of its force. `model` ends with it, the building is as its place left it. The best of
/// forces from .02 to .6 of the spring's at its largest deformation; not good where none can be
/// computed.
FitResult friction_start(const Fitter& fitter, const Model& model);

}  // namespace framewatch::estimator
