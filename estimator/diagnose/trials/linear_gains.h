#pragma once

#include <vector>

#include "estimator/diagnose/trials/trial_context.h"

namespace framewatch::estimator {

/// What one step of the fit from the present model makes of a linear effect that it does not have.
struct LinearGain {
  double cost = 0;   ///< by which the cost falls more than without the effect
  double value = 0;  ///< of the effect's first parameter after the step
};

/// Of every effect, alone. effects: none of them a law of elements, zero when their first parameter
/// is.
std::vector<LinearGain> linear_gains(const TrialContext& context,
                                     const std::vector<ModelEffect>& effects);

}  // namespace framewatch::estimator
