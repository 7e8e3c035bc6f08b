#pragma once

#include <string>
#include <vector>

#include "estimator/diagnose/diagnosis.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// Plans of the stories, the top one first, as inline SVGs: frames as lines, floor panels as
/// squares, sensors as circles, masses where frames cross. The less of the misfit is left when a
/// place may do anything, the wider and stronger it is drawn; the three best that have a place in a
/// plan carry their number. `ratio_before`: misfit over noise without any place.
std::vector<std::string> where_map(const Structure& structure, const std::vector<SensorAxis>& axes,
                                   const std::vector<WhereEntry>& map, double ratio_before);

}  // namespace framewatch::daemon
