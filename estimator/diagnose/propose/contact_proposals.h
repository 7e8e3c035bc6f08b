// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/propose/needed_signal.h"

namespace framewatch::estimator {

/// Adds contacts of a floor with the ground or with another floor. pair: place with story, to_story
/// and frame (PlaceKind::node_pair). needed: the force of a node or of a pair.
void add_contact_proposals(const Fitter& fitter, const Localisation& place,
                           const std::vector<NeededSignal>& needed, const EffectPlace& pair,
                           std::vector<Proposal>& out);

/// Returns laws that act alike in all elements of a direction or of a frame: elastic laws, and one
/// with joints that slip.
std::vector<Proposal> amplitude_proposals(const Fitter& fitter, const Localisation& place,
                                          const EffectPlace& frames);

/// Adds laws of all elements of a direction, and of each of its frames.
void add_amplitude_proposals(const Fitter& fitter, const Localisation& place,
                             std::vector<Proposal>& out);

}  // namespace framewatch::estimator
