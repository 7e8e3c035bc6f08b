// SPDX-License-Identifier: MIT
#pragma once

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/trials/found_effect.h"

namespace framewatch::estimator {

/// Adds the effects of a configuration to a model, to be fitted with everything else. Ramps of
/// bias_drift are not part of a model: remove_ramps() subtracts them from the segments.
std::vector<FoundEffect> add_known(const Plant& plant, const std::vector<RecordSegment>& segments,
                                   const std::vector<Effect>& effects, Model& model);

}  // namespace framewatch::estimator
