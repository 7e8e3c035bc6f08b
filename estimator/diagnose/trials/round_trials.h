#pragma once

#include <vector>

#include "estimator/diagnose/locate/locate.h"
#include "estimator/diagnose/trials/found_effect.h"
#include "estimator/diagnose/trials/trials.h"

namespace framewatch::estimator {

constexpr double kOnePlace = 1.6;  ///< ratio above which one place does not suffice

/// Whether the best place is an element.
bool is_element(const Localisation& place);

/// Misfit that effects at these places should leave: that under arbitrary signals, scaled up by the
/// equations which these remove.
double bound_of(const Plant& plant, const Localisation& places);

/// Replaces the located places by those that leave least beside the place of an element law found
/// before, if that is the best one or about as likely and does not suffice alone. None stay where
/// the rest may be the shape of such a law.
void relocate_beside(const TrialContext& context, const std::vector<FoundEffect>& found,
                     Located& located);

/// Fits the laws of the likeliest places. small: linear effects and those of axes only.
std::vector<Trial> trials_of_places(const TrialContext& context, const Located& located,
                                    bool small);

/// Fits one law of all stories of a frame. frame: -1: the likeliest, that of the best place of one
/// direction.
std::vector<Trial> trials_of_whole_frame(const TrialContext& context, const Located& located,
                                         int frame);

/// Fits two laws at two places, if two places explain what one does not; sets bound to theirs then.
/// needed: a reduction of the cost that is more than chance.
std::vector<Trial> trials_of_pairs(const TrialContext& context, const Located& located,
                                   double needed, double& bound);

/// Whether a trial leaves less than a bound: then no law at the places whose bound it is does as
/// well, because none leaves less than a force that may be anything.
bool leaves_less(const std::vector<Trial>& trials, double bound);

}  // namespace framewatch::estimator
