// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/trials/trial.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// Adds a damping ratio (LawForm::modal_damping) for every mode of a model without one. The ratios
/// are zero and held until with_free_damping() frees them. Does nothing in large buildings and
/// component tests.
void add_modal_damping(const Plant& plant, Model& model);

/// Fits with free damping ratios of all modes in the band, because dashpots between floors may not
/// describe the damping. The result is not good if only noise is left already, or if no ratio is
/// held.
FitResult with_free_damping(const Fitter& fitter, const FitResult& now);

/// Returns true if one dashpot between two floors or to the ground does as well as the ratios of
/// `with`. The dashpot is then the finding, not the form of the damping.
bool one_damper_does(const TrialContext& context, const FitResult& with);

/// Keeps the ratios of `with` (from with_free_damping() of `now`) that reduce the cost by more than
/// their price. Resets the ratios of `now` to zero if they no longer do.
void settle_damping(const Fitter& fitter, FitResult with, FitResult& now);

/// Returns a model's damping ratios in the catalog's form.
std::vector<Effect> modal_damping_effects(const Model& model);

}  // namespace framewatch::estimator
