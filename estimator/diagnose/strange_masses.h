#pragma once

#include <vector>

#include "estimator/diagnose/locate.h"
#include "estimator/diagnose/trials.h"

namespace framewatch {

/// Cost of masses off what is declared, above what chance has, that one effect has to explain.
constexpr double kStrangeMasses = 15;

/// A model may fit because masses have been taken farther from what is declared than chance takes
/// them: one extra mass at every node, one spring or damper between floors or to the ground, a base
/// or frames that turn; those that do away with it, best first. None when two do about as well.
std::vector<Trial> strange_masses(const TrialContext& context, const Located& located);

}  // namespace framewatch
