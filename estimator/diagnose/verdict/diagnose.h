// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/verdict/diagnosis.h"

namespace framewatch::estimator {

/// Runs the method of docs/diagnosis.md on segments of one building. Deterministic: the result does
/// not depend on DiagnosisOptions::parallel.
Diagnosis diagnose(const Plant& plant, const std::vector<RecordSegment>& segments,
                   const DiagnosisOptions& options);

}  // namespace framewatch::estimator
