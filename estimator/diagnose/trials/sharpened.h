#pragma once

#include "estimator/diagnose/trials/trial.h"
#include "estimator/diagnose/trials/trial_context.h"

namespace framewatch::estimator {

/// Refines a trial, starting from `from`, with the shape of hysteresis free. Returns the trial
/// unchanged if that is not better.
Trial sharpened(const TrialContext& context, const Trial& trial, const Model& from);

/// Returns a model fitted to the record with the smallest relative misfit. A strongly nonlinear law
/// may converge there where a fit to all records does not.
Model fitted_to_the_weakest(const TrialContext& context, const Model& model);

/// Frees the shapes of all laws (free_shape).
void free_shapes(Model& model);

}  // namespace framewatch::estimator
