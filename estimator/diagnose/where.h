#pragma once

#include <vector>

#include "estimator/diagnose/diagnosis.h"

namespace framewatch {

/// What places need in order to explain everything: when, at which frequencies, how much.
std::vector<WhereEntry> where_of(const Fitter& fitter, const std::vector<Localisation>& places);

}  // namespace framewatch
