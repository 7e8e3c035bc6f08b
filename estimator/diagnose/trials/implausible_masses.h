// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/locate/locate.h"
#include "estimator/diagnose/trials/trials.h"

namespace framewatch::estimator {

/// Checks if a model fits only because its masses differ from the declared ones by more than
/// chance. Tries a single linear effect instead: an extra mass at a node, a spring or damper
/// between floors or to the ground, rotation of the base or of the frames. Returns those that make
/// the masses plausible, best first. Returns an empty list if two do about as well.
std::vector<Trial> implausible_masses(const TrialContext& context, const Located& located);

}  // namespace framewatch::estimator
