#pragma once

#include <vector>

#include "estimator/diagnose/verdict/diagnosis.h"

namespace framewatch::estimator {

/// Subtracts the ramps of the configuration (DiagnosisOptions::known) and those it finds from the
/// segments. Returns the ramps that it found.
std::vector<FoundEffect> remove_ramps(const Plant& plant, const DiagnosisOptions& options,
                                      std::vector<RecordSegment>& segments);

/// Adds the ramps, which lie below the band, to the gap before the diagnosis.
void add_ramps_to_gaps(const Plant& plant, const std::vector<RecordSegment>& segments,
                       std::size_t holdout_from, Diagnosis& diagnosis);

}  // namespace framewatch::estimator
