#pragma once

#include <vector>

#include "estimator/diagnose/fit/fit.h"

namespace framewatch::estimator {

/// Start values for the free run of a fit that was driven by measured, noisy motion. A stiff
/// mechanical clearance comes out of such a fit softer and wider than it is, and a free run does
/// not converge from there: the best of some stiffer and narrower ones is returned. Fits without a
/// clearance, and those that fit already, are returned unchanged.
FitResult free_run_start(const Fitter& fitter, FitResult fit);

/// Start values for the free run of friction that sticks so long that measured, noisy motion says
/// little of its force. `model` ends with it, the building is as its place left it. Of forces from
/// .02 to 1.8 of the spring's at its largest deformation those that come nearer than their
/// neighbours, two at most, best first.
std::vector<FitResult> friction_starts(const Fitter& fitter, const Model& model);

}  // namespace framewatch::estimator
