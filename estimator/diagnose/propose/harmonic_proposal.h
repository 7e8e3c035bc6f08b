#pragma once

#include <vector>

#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/diagnose/propose/proposal.h"

namespace framewatch::estimator {

/// Returns an external harmonic force at a node: the strongest frequency in the needed force, and
/// its onset and two amplitudes in every record.
Proposal harmonic_proposal(const Fitter& fitter, const Localisation& place,
                           const std::vector<NeededSignal>& needed, const EffectPlace& node);

}  // namespace framewatch::estimator
