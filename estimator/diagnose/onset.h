#pragma once

#include "estimator/diagnose/fit.h"

namespace framewatch {

/// Whether the last effect of a model is a harmonic force.
bool ends_with_harmonic(const Model& model);

/// A fit whose last effect is a harmonic force, which begins in every record where the whole model
/// fits best: seen in the measured motion alone its first second or so may be lost. Descent over
/// one record after another, from where it seems to begin and from the record's beginning.
FitResult with_onsets(const Fitter& fitter, FitResult fit);

}  // namespace framewatch
