// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/locate/locate.h"
#include "estimator/diagnose/trials/found_effect.h"
#include "estimator/diagnose/trials/trials.h"

namespace framewatch::estimator {

/// Returns true if the first place is an element.
bool is_element(const Localisation& place);

/// Returns the misfit that effects at these places should leave: the misfit with arbitrary signals
/// there, scaled up for the equations that these signals remove.
double bound_of(const Plant& plant, const Localisation& places);

/// Replaces the located places by pairs with the place of an earlier element law, if that place is
/// the best or about as likely and does not suffice alone. Clears the places if the rest may be the
/// shape of that law.
void relocate_beside(const TrialContext& context, const std::vector<FoundEffect>& found,
                     Located& located);

/// Fits the laws of the likeliest places. small: only linear effects and those of axes.
std::vector<Trial> trials_of_places(const TrialContext& context, const Located& located,
                                    bool small);

/// Fits one law of all stories of a frame. frame: -1: the frame of the likeliest place that has
/// one.
std::vector<Trial> trials_of_whole_frame(const TrialContext& context, const Located& located,
                                         int frame);

/// Fits two laws at two places if two places explain what one does not, and then sets `bound` to
/// theirs. needed: a reduction of the cost that is more than chance.
std::vector<Trial> trials_of_pairs(const TrialContext& context, const Located& located,
                                   double needed, double& bound);

/// Returns true if a trial leaves less than a bound. Then no law at the places of that bound does
/// as well, because none leaves less than an arbitrary force.
bool leaves_less(const std::vector<Trial>& trials, double bound);

}  // namespace framewatch::estimator
