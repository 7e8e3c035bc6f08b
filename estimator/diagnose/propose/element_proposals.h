// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/propose/needed_signal.h"

namespace framewatch::estimator {

/// Returns an effect of the form `changing` with the times of its stiffness change: its start and
/// duration in every record, with one amplitude for all records. sudden: the duration is fixed.
ModelEffect timed_change(const Fitter& fitter, const std::vector<NeededSignal>& needed,
                         ModelEffect effect, bool sudden);

/// Returns every law that can act in an element, each with the best of a grid of start values.
/// element: index of its stiffness in theta.
std::vector<Proposal> element_proposals(const Fitter& fitter, const Localisation& place,
                                        const std::vector<NeededSignal>& needed, int element);

}  // namespace framewatch::estimator
