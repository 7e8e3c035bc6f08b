#pragma once

#include <vector>

#include "estimator/diagnose/locate/localise.h"
#include "estimator/diagnose/propose/proposal.h"

namespace framewatch::estimator {

/// Adds the possible errors of the axis of a localization: gain or polarity, delay, misalignment,
/// clipping.
void add_axis_proposals(const Fitter& fitter, const Localisation& place,
                        std::vector<Proposal>& out);

}  // namespace framewatch::estimator
