// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/trials/found_effect.h"
#include "estimator/diagnose/trials/trial.h"
#include "estimator/diagnose/trials/trials.h"

namespace framewatch::estimator {

/// Ranks trials, best first, refines the leading ones and sets Trial::fraction; trials without a
/// complete fit come last. Returns true if the best one explains enough of the misfit and worsens
/// no record. bound: misfit that arbitrary forces would leave; needed: reduction that is more than
/// chance.
bool select_trial(const TrialContext& context, double bound, double needed,
                  std::vector<Trial>& trials);

/// Returns true if a trial is an element law that explains most of the misfit beyond noise and
/// worsens no record. For laws that select_trial() did not accept.
bool is_nearest_law(const TrialContext& context, const Trial& trial);

/// Returns the number of fitted values of a model beyond those of the linear building.
double fitted_values(const Model& model);

/// Returns true if a trial fits any record worse than the present model, by more than chance.
bool worsens(const Fitter& fitter, const Trial& trial, const FitResult& now, double chance);

/// Compares a found law again with the best alternatives at its place, each fitted as its
/// replacement in the present model. The first comparison knew neither the form of the damping nor
/// other effects. Keeps the best of them in `effect` and `now`, and lowers the confidence
/// accordingly. Returns true if a replacement won.
bool choose_replacement(const TrialContext& context, FoundEffect& effect, FitResult& now);

}  // namespace framewatch::estimator
