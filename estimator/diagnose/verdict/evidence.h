// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "estimator/diagnose/verdict/diagnosis.h"

namespace framewatch::estimator {

/// Returns the evidence for a diagnosis whose gaps and effects are set. segments: as it used them,
/// without ramps. Empty if the diagnosis has no gaps.
Evidence evidence_of(const Plant& plant, const std::vector<RecordSegment>& segments,
                     std::size_t holdout_from, const Diagnosis& diagnosis);

/// Returns the misfit of a trial over the expected one, with all segments: 1 if only noise is left.
/// NaN if it was not fitted. Like Diagnosis::ratio_before, but of the round of the trial.
double misfit_ratio(const Plant& plant, const std::vector<RecordSegment>& segments,
                    const Trial& trial);

}  // namespace framewatch::estimator
