// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/refine/max_likelihood.h"

namespace framewatch::estimator {

/// Returns the estimate that several independent ones of the same parameters give together: their
/// mean, weighted with the inverses of their covariances. If they differ by more than these allow,
/// the covariance grows in proportion (Birge 1932). Estimates that did not converge, or whose
/// covariance is not finite, are left out; if none remains, the result is the first estimate. Bound
/// and misfit are of all that count; band and bins are those of the first that counts.
/// Precondition: at least one estimate.
Refinement combine(const std::vector<Refinement>& estimates);

}  // namespace framewatch::estimator
