#pragma once

#include <vector>

#include "estimator/diagnose/trials.h"

namespace framewatch {

/// Sorts trials, best first, fits the leading ones to their end and sets their shares of what is to
/// be explained; those that were not fitted to their end come last. Whether the best one explains
/// enough of it and no record worse than before. bound: misfit that forces which may be anything
/// would leave; needed: what is more than chance.
bool settle(const TrialContext& context, double bound, double needed, std::vector<Trial>& trials);

/// Whether a trial explains any record less than the model does, by more than chance.
bool worsens(const Trial& trial, const FitResult& now, double chance);

}  // namespace framewatch
