#pragma once

#include <vector>

#include "estimator/diagnose/trials/found_effect.h"
#include "estimator/diagnose/trials/trial_context.h"

namespace framewatch::estimator {

/// Compares a found law again with the best alternatives at its place, each fitted as its
/// replacement in the present model. The first comparison knew neither the form of the damping nor
/// other effects. Keeps the best of them in `effect` and `now`, and lowers the confidence
/// accordingly. Returns true if a replacement won.
bool choose_again(const TrialContext& context, FoundEffect& effect, FitResult& now);

}  // namespace framewatch::estimator
