#pragma once

#include "estimator/diagnose/diagnosis.h"

namespace framewatch {

/// Puts the effects that a configuration has into a model, to be fitted with everything else.
/// Ramps of bias_drift are no part of a model: remove_ramp() takes them off the stretches.
std::vector<FoundEffect> add_known(const Plant& plant, const std::vector<Stretch>& stretches,
                                   const std::vector<Effect>& effects, Model& model);

}  // namespace framewatch
