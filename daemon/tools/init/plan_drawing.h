// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/tools/init/building_plan.h"

namespace framewatch::daemon {

/// Returns the floors with their channels, top first, and a plan for each arrangement of
/// accelerometers, in characters for a terminal.
std::string plan_text(const BuildingPlan& plan);

/// Returns the same as an SVG picture.
std::string plan_svg(const BuildingPlan& plan);

}  // namespace framewatch::daemon
