// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/trials/trial.h"

namespace framewatch::estimator {

/// Tries channels with reversed sign, also at the base, and pairs of channels with exchanged names.
/// Runs before anything else, and only if the model is far from the records. Returns the trials,
/// best first, or an empty list unless the best one removes most of the misfit. Not for large
/// buildings, where exchanged channels are found among the pairs of places.
std::vector<Trial> wrong_labels(const TrialContext& context);

}  // namespace framewatch::estimator
