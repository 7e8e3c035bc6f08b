// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/propose/needed_signal.h"

namespace framewatch::estimator {

/// Adds effects that may act at a node: a hidden oscillator, an external harmonic force and, if the
/// force does not follow the building's motion, an arbitrary force.
void add_node_proposals(const Fitter& fitter, const Localisation& place,
                        const std::vector<NeededSignal>& needed, const EffectPlace& node,
                        std::vector<Proposal>& out);

}  // namespace framewatch::estimator
