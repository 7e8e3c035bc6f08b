#pragma once

#include "estimator/diagnose/trials.h"

namespace framewatch {

/// Whether a name must not be given.
bool is_taken_out(const TrialContext& c, EffectKind kind);

/// What a fit has become, and its name.
void take(const TrialContext& c, const FitResult& run, Trial& t);

/// Whether its names may be given. A slip zone in what hardly yields is another elastic law; a mass
/// on a spring so stiff that it resonates above the band is a mass, one heavier than its floor
/// nothing that was ever built; springs do not push.
bool is_named(const TrialContext& c, const Trial& t);

}  // namespace framewatch
