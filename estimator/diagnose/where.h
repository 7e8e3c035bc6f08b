#pragma once

#include <vector>

#include "estimator/diagnose/diagnosis.h"
#include "estimator/diagnose/locate.h"

namespace framewatch {

/// What places need in order to explain everything: when, at which frequencies, how much.
std::vector<WhereEntry> where_of(const Fitter& fitter, const std::vector<Localisation>& places);

/// Every place, best first: as iterated where that was done, after one step elsewhere.
std::vector<WhereEntry> map_of(const Located& located);

}  // namespace framewatch
