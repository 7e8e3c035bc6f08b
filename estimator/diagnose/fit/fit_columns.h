#pragma once

#include <vector>

#include "estimator/diagnose/fit/unknowns.h"
#include "estimator/diagnose/fit/whitened.h"

namespace framewatch::estimator {

/// Derivatives of a whitened segment by the unknowns: rows x unknowns. ratio: steps per sample of
/// the laws; through_run: with the derivatives of the free run's motion.
RowMatrix columns_of(const Plant& plant, const Model& model, const RecordSegment& segment,
                     std::size_t record, const Whitened& system,
                     const std::vector<Unknown>& unknowns, int ratio, bool through_run);

}  // namespace framewatch::estimator
