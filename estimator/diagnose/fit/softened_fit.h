// SPDX-License-Identifier: MIT
#pragma once

#include "estimator/diagnose/fit/fit.h"

namespace framewatch::estimator {

/// Returns `now` fitted again with the model's error counted as noise. The error's power is
/// estimated for each bin from the residual. The bins that the model explains decide, so an effect
/// that it lacks, for example a resonance, hardly changes its stiffness and damping. The misfit and
/// the cost of the result are those under noise alone; they exceed those of `now`. Returns `now` if
/// it is near the noise or cannot be fitted.
FitResult softened_fit(const Fitter& fitter, const FitResult& now);

}  // namespace framewatch::estimator
