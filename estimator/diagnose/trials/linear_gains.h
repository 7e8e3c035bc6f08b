// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/trials/trial.h"

namespace framewatch::estimator {

/// Effect of one step of the fit from the present model with one more linear effect.
struct LinearGain {
  double cost = 0;   ///< additional fall of the cost due to the effect
  double value = 0;  ///< of the effect's first parameter after the step
};

/// Returns the gain of each effect alone. effects: not element laws; each has no influence if its
/// first parameter is zero.
std::vector<LinearGain> linear_gains(const TrialContext& context,
                                     const std::vector<ModelEffect>& effects);

}  // namespace framewatch::estimator
