#pragma once

#include <vector>

#include "estimator/diagnose/trials/trial.h"
#include "estimator/diagnose/trials/trial_context.h"

namespace framewatch::estimator {

/// A law of the deformation and a dissipative one together at an element, best first: how a part
/// springs back does not say how it damps, nor the other way round. Hysteresis is both, and none of
/// them. context: of the model without a law there.
std::vector<Trial> trials_of_two_sorts(const TrialContext& context, const EffectPlace& element);

}  // namespace framewatch::estimator
