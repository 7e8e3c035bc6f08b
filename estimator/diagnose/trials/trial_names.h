// SPDX-License-Identifier: MIT
#pragma once

#include "estimator/diagnose/trials/found_effect.h"
#include "estimator/diagnose/trials/trial.h"

namespace framewatch::estimator {

/// Returns true if a name is excluded (DiagnosisOptions::without).
bool is_excluded(const TrialContext& context, EffectKind kind);

/// Sets a trial's model, cost and misfit to those of a fit, and its names to those of the fitted
/// values.
void set_fit(const TrialContext& context, const FitResult& fit, Trial& trial);

/// Returns true if a trial's names are allowed. They are not if a name is excluded, or if the
/// fitted values are those of another effect or physically impossible: pinching that hardly
/// dissipates, a resonator above the band or heavier than its floor, a negative spring or damper.
bool may_be_named(const TrialContext& context, const Trial& trial);

/// Names element laws by their fitted shapes in context.now, unless those names are excluded.
void name_by_shape(const TrialContext& context, std::vector<FoundEffect>& effects);

}  // namespace framewatch::estimator
