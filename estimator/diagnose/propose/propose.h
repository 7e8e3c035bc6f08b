#pragma once

#include <vector>

#include "estimator/diagnose/locate/localise.h"
#include "estimator/diagnose/propose/proposal.h"

namespace framewatch::estimator {

/// All laws of the catalogue that can act at the `which`-th place of a localisation; at elements
/// and nodes sorted by the misfit of their scalar fit, best first.
std::vector<Proposal> propose(const Fitter& fitter, const Localisation& place, std::size_t which);

/// The linear effects beside stiffness and damping of elements that may be at the first place: an
/// extra mass, a spring or damper between floors or to the ground, rotation of base or frames.
std::vector<Proposal> propose_linear(const Plant& plant, const Localisation& place);

}  // namespace framewatch::estimator
