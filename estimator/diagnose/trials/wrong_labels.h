#pragma once

#include <vector>

#include "estimator/diagnose/trials/trial_context.h"

namespace framewatch::estimator {

/// A channel that reads the wrong way round, at the base too, or two channels that are named as
/// each other, tried before anything else: where the model is far from the records, whatever else
/// is missing. Best first; empty unless the best takes most of the misfit away. Not of large
/// buildings, whose exchanged channels are found among the pairs of places.
std::vector<Trial> wrong_labels(const TrialContext& context);

}  // namespace framewatch::estimator
