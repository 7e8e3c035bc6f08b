#pragma once

#include <vector>

#include "estimator/diagnose/trials/trial.h"
#include "estimator/diagnose/trials/trial_context.h"

namespace framewatch::estimator {

/// Returns trials that combine a law of the deformation and a dissipative law at an element, best
/// first. The elastic force of a part does not determine its damping, nor the reverse. Hysteresis
/// is both, so it is left out. context: of the model without a law there.
std::vector<Trial> trials_of_two_sorts(const TrialContext& context, const EffectPlace& element);

}  // namespace framewatch::estimator
