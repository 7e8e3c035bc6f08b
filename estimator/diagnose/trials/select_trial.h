#pragma once

#include <vector>

#include "estimator/diagnose/trials/trials.h"

namespace framewatch::estimator {

/// Ranks trials, best first, fits the leading ones on and sets Trial::fraction; those without a
/// complete fit come last. Whether the best one explains enough of the misfit and worsens no
/// record. bound: misfit that arbitrary forces would leave; needed: reduction that is more than
/// chance.
bool select_trial(const TrialContext& context, double bound, double needed,
                  std::vector<Trial>& trials);

/// Whether a trial is a law of an element that takes most of the misfit beyond noise, and worsens
/// no record, though it does not hold.
bool is_nearest_law(const TrialContext& context, const Trial& trial);

/// Number of fitted values of a model beyond those of the linear building.
double fitted_values(const Model& model);

/// Whether a trial fits any record worse than the present model does, by more than chance.
bool worsens(const Trial& trial, const FitResult& now, double chance);

}  // namespace framewatch::estimator
