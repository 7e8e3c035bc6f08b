#pragma once

#include "estimator/diagnose/fit/fit.h"

namespace framewatch::estimator {

/// Whether the last effect of a model is a harmonic force.
bool ends_with_harmonic(const Model& model);

/// Refines the onsets of the harmonic force that is a fit's last effect: in every record, one after
/// another, the onset where the whole model fits best, by descent from the present onset and from
/// the record's beginning. The measured motion alone may miss the first second or so.
FitResult with_onsets(const Fitter& fitter, FitResult fit);

}  // namespace framewatch::estimator
