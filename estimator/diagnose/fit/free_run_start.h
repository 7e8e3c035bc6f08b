// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/fit/fit.h"

namespace framewatch::estimator {

/// Returns start values for the free run of a fit that was driven by measured, noisy motion. Such a
/// fit finds a stiff mechanical clearance too soft and too wide, and a free run does not converge
/// from there. Tries stiffer and narrower clearances and returns the best. Returns fits without a
/// clearance, and fits that are good already, unchanged.
FitResult free_run_start(const Fitter& fitter, FitResult fit);

/// Returns start values for the free run of friction that sticks so long that measured, noisy
/// motion does not determine its force. model: ends with the friction; the building is fitted with
/// arbitrary signals at its place. Tries forces from 0.02 to 1.8 of the spring's force at its
/// largest deformation. Returns at most two local optima, best first.
std::vector<FitResult> friction_starts(const Fitter& fitter, const Model& model);

/// Returns true if the last effect of a model is a harmonic force.
bool ends_with_harmonic(const Model& model);

/// Refines the onsets of the harmonic force that is a fit's last effect. In one record after
/// another it descends to the onset where the whole model fits best, from the present onset and
/// from the record's start. The measured motion alone may miss the first second or so.
FitResult with_onsets(const Fitter& fitter, FitResult fit);

}  // namespace framewatch::estimator
