#pragma once

#include "estimator/diagnose/trials/found_effect.h"
#include "estimator/diagnose/trials/trial_context.h"

namespace framewatch::estimator {

/// Whether a name must not be given (DiagnosisOptions::without).
bool is_excluded(const TrialContext& context, EffectKind kind);

/// Sets a trial's model, cost and misfit to those of a fit, and its names to those that the fitted
/// values have.
void set_fit(const TrialContext& context, const FitResult& fit, Trial& trial);

/// Whether a trial's names may be given. Not when a name is excluded or the fitted values are those
/// of another effect or physically impossible: pinching that hardly dissipates, a resonator above
/// the band or heavier than its floor, a negative spring or damper.
bool may_be_named(const TrialContext& context, const Trial& trial);

/// Names laws of elements by the shapes that they have in the model of context.now, where those
/// names are not excluded.
void name_by_shape(const TrialContext& context, std::vector<FoundEffect>& effects);

}  // namespace framewatch::estimator
