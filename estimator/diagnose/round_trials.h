#pragma once

#include <vector>

#include "estimator/diagnose/locate.h"
#include "estimator/diagnose/trials.h"

namespace framewatch {

constexpr double kOnePlace = 1.6;  ///< ratio above which one place does not do

bool is_element(const Localisation& place);

/// Misfit that effects at these places should leave if their forces may be anything.
double bound_of(const Plant& plant, const Localisation& places);

/// Where the best place is that of a law found before and does not do alone: the places beside it.
void look_beside(const TrialContext& context, const std::vector<FoundEffect>& found,
                 Located& located);

/// What may act at the likeliest places; small: nothing but linear effects and those of axes.
std::vector<Trial> trials_of_places(const TrialContext& context, const Located& located,
                                    bool small);

/// Two laws at two places, where two explain what one does not; bound becomes theirs then.
std::vector<Trial> trials_of_pairs(const TrialContext& context, const Located& located,
                                   double& bound);

}  // namespace framewatch
