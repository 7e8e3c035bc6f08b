#pragma once

#include <vector>

#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/diagnose/propose/proposal.h"

namespace framewatch::estimator {

/// Returns every law that can act in an element, each with the best of a grid of start values.
/// element: index of its stiffness in theta.
std::vector<Proposal> element_proposals(const Fitter& fitter, const Localisation& place,
                                        const std::vector<NeededSignal>& needed, int element);

}  // namespace framewatch::estimator
