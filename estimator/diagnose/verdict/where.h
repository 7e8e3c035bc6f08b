#pragma once

#include <vector>

#include "estimator/diagnose/locate/locate.h"
#include "estimator/diagnose/verdict/diagnosis.h"

namespace framewatch::estimator {

/// The signal that each place needs: when, at which frequencies and how large; of the first element
/// among the best three, what sort of force it is.
std::vector<WhereEntry> where_of(const Fitter& fitter, const std::vector<Localisation>& places);

/// Every place, best first: as iterated where that was done, after one step elsewhere.
std::vector<WhereEntry> map_of(const Located& located);

}  // namespace framewatch::estimator
