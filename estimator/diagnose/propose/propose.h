#pragma once

#include <vector>

#include "estimator/diagnose/locate/localise.h"
#include "estimator/diagnose/propose/proposal.h"

namespace framewatch::estimator {

/// All laws of the catalogue that can act at the `which`-th place of a localisation; at elements
/// and nodes sorted by the misfit of their scalar fit, best first.
std::vector<Proposal> propose(const Fitter& fitter, const Localisation& place, std::size_t which);

}  // namespace framewatch::estimator
