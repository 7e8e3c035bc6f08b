// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/tools/diagnosis/diagnose_verdict.h"
#include "estimator/structure/effect.h"

namespace framewatch::daemon {

/// An effect at its place, as a name that competes with others.
struct NamedEffect {
  estimator::EffectKind kind = estimator::EffectKind::cubic_stiffness;
  estimator::EffectPlace place;
};

/// Returns one or two sentences: the measurement that tells an effect from its rivals. Derived from
/// their kinds and places alone; "" without rivals. peak_m: largest deformation so far, 0 if
/// unknown.
std::string measurement_between(const NamedEffect& best, const std::vector<NamedEffect>& rivals,
                                const estimator::Structure& structure,
                                const std::vector<estimator::SensorAxis>& axes, double peak_m);

/// Returns what to measure next; "" if every name is established, or if nothing is missing.
std::string next_measurement(const DiagnoseOutput& output);

}  // namespace framewatch::daemon
