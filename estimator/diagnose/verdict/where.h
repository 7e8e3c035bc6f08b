#pragma once

#include <vector>

#include "estimator/diagnose/locate/locate.h"
#include "estimator/diagnose/verdict/diagnosis.h"

namespace framewatch::estimator {

/// Describes the signal that each place needs: its time, frequencies and size. For the first
/// element and the first floor among the best three, also the kind of force.
std::vector<WhereEntry> where_of(const Fitter& fitter, const std::vector<Localisation>& places);

/// Returns every place, best first. Uses the iterated localization of a place if there is one,
/// otherwise the one after one step.
std::vector<WhereEntry> map_of(const Located& located);

}  // namespace framewatch::estimator
