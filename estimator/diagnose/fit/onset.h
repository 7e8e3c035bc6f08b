#pragma once

#include "estimator/diagnose/fit/fit.h"

namespace framewatch::estimator {

/// Returns true if the last effect of a model is a harmonic force.
bool ends_with_harmonic(const Model& model);

/// Refines the onsets of the harmonic force that is a fit's last effect. In one record after
/// another it descends to the onset where the whole model fits best, from the present onset and
/// from the record's start. The measured motion alone may miss the first second or so.
FitResult with_onsets(const Fitter& fitter, FitResult fit);

}  // namespace framewatch::estimator
