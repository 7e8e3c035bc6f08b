// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/locate/localise.h"
#include "estimator/diagnose/propose/needed_signal.h"

namespace framewatch::estimator {

/// Returns all laws of the catalog that can act at the `which`-th place of a localization. At
/// elements and nodes they are sorted by the misfit of their scalar fit, best first.
std::vector<Proposal> propose(const Fitter& fitter, const Localisation& place, std::size_t which);

/// Returns the linear effects, other than stiffness and damping of elements, that are possible at
/// the first place: an extra mass, a spring or damper between floors or to the ground, rotation of
/// base or frames.
std::vector<Proposal> propose_linear(const Plant& plant, const Localisation& place);

}  // namespace framewatch::estimator
