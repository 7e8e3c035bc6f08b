#pragma once

#include <vector>

#include "estimator/diagnose/diagnosis.h"

namespace framewatch {

/// Ramps that the configuration knows, and those that are found, taken off the stretches. Returns
/// the latter.
std::vector<FoundEffect> take_ramps(const Plant& plant, const DiagnosisOptions& options,
                                    std::vector<Stretch>& stretches);

/// Adds to the gap before what ramps do below the band.
void count_ramps(const std::vector<Stretch>& stretches, std::size_t holdout_from,
                 Diagnosis& diagnosis);

}  // namespace framewatch
