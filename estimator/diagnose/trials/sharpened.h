#pragma once

#include "estimator/diagnose/trials/trial.h"
#include "estimator/diagnose/trials/trial_context.h"

namespace framewatch::estimator {

/// A trial fitted on from a model of its kind, with the shape of hysteresis free; unchanged when
/// that is no better.
Trial sharpened(const TrialContext& context, const Trial& trial, const Model& from);

/// A model fitted to the one record with the smallest relative misfit. A strongly nonlinear law
/// converges there where a fit to all records does not.
Model fitted_to_the_weakest(const TrialContext& context, const Model& model);

/// Frees the shapes of all laws (free_shape).
void free_shapes(Model& model);

}  // namespace framewatch::estimator
