#pragma once

#include <vector>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/trials/trial_context.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// Gives a model a place for a ratio of every mode (LawForm::modal_damping) that it has none of:
/// zero, and held there until with_free_damping() frees it. Not in large buildings and component
/// tests.
void add_modal_damping(const Plant& plant, Model& model);

/// Damping may be none of dashpots between floors: the fit with ratios of all modes in the band,
/// whatever they are worth. Not good where nothing but noise is left already, or none is held.
FitResult with_free_damping(const Fitter& fitter, const FitResult& now);

/// Whether one dashpot between two floors or to the ground, one that the building has not, does as
/// well as the ratios of `with`: then it is the finding, not the form of the damping.
bool one_damper_does(const TrialContext& context, const FitResult& with);

/// Keeps of `with`, with_free_damping() of `now`, the ratios that are worth their price; those that
/// `now` has already and that are not worth it any more are zero again.
void settle_damping(const Fitter& fitter, FitResult with, FitResult& now);

/// The ratios that a model has, as the catalogue writes them.
std::vector<Effect> modal_damping_effects(const Model& model);

}  // namespace framewatch::estimator
