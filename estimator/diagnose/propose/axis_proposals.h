#pragma once

#include <vector>

#include "estimator/diagnose/locate/localise.h"
#include "estimator/diagnose/propose/proposal.h"

namespace framewatch::estimator {

/// Adds the errors that the axis of a localisation may have: gain or polarity, delay, misalignment,
/// clipping.
void add_axis_proposals(const Fitter& fitter, const Localisation& place,
                        std::vector<Proposal>& out);

}  // namespace framewatch::estimator
