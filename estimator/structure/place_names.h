#pragma once

#include <string>

#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// x1y1: the y-parallel, then the x-parallel frame; the one frame's name in a plane building.
std::string crossing_name(const Structure& structure, int crossing);
/// Of the crossing where its spans start, as in Gk_2_x1y1.
std::string panel_name(const Structure& structure, int panel);

}  // namespace framewatch::estimator
