// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/tools/init/building_plan.h"

namespace framewatch::daemon {

/// The plan as a configuration with comments, which `framewatch check` accepts.
std::string building_toml(const BuildingPlan& plan);

}  // namespace framewatch::daemon
