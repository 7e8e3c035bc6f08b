#pragma once

#include "estimator/diagnose/fit.h"

namespace framewatch {

/// Where the fit of a run begins, after one that was driven by measured, noisy motion. There a
/// stiff gap comes out softer and wider than it is, and from there its run finds no way: the best
/// of some stiffer and narrower ones. A harmonic force may seem to begin after the record does: it
/// begins with it where that fits better. Other fits as they are.
FitResult begin_run(const Fitter& fitter, FitResult fit);

}  // namespace framewatch
