#pragma once

#include <vector>

#include "estimator/diagnose/trials/found_effect.h"
#include "estimator/diagnose/trials/trial_context.h"

namespace framewatch::estimator {

/// Laws were compared when neither the form of the damping nor a second effect was known: the best
/// of those that were tried at the place of a found law, each fitted in its stead in the present
/// model. The best of them and the law itself stays, `now` with it; its name is no surer than these
/// let it be. Whether another law stays.
bool choose_again(const TrialContext& context, FoundEffect& effect, FitResult& now);

}  // namespace framewatch::estimator
