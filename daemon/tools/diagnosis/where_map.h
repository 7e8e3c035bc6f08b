// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "estimator/diagnose/verdict/diagnosis.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// Draws plans of the stories, the top one first, as inline SVGs. Frames are lines, floor panels
/// squares, sensors circles, masses squares where frames cross. A place is drawn wider and stronger
/// the less misfit an arbitrary signal there leaves; the three best in a plan are numbered.
/// ratio_before: misfit over its expectation under noise, without any place.
std::vector<std::string> where_map(const estimator::Structure& structure,
                                   const std::vector<estimator::SensorAxis>& axes,
                                   const std::vector<estimator::WhereEntry>& map,
                                   double ratio_before);

}  // namespace framewatch::daemon
