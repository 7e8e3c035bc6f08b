#pragma once

#include <string>

#include "estimator/shaking/story_drift.h"

namespace framewatch::daemon {

/// "3.21 kN": a force in the unit that an engineer would write.
std::string force_words(double newton);
/// "1.73 %", "0.0421 %": three digits that count.
std::string drift_words(double ratio);
/// "1.23 kN along x, 56 N along y", of the directions that the structure has frames in.
std::string base_shear_words(const estimator::PeakResponse& peak,
                             const estimator::Structure& structure);

}  // namespace framewatch::daemon
