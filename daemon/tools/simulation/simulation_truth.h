#pragma once

#include <string>

#include "daemon/tools/simulation/simulation.h"

namespace framewatch::daemon {

/// What a scenario hides, as JSON (docs/formats.md): the first effect under "hidden", all of them
/// under "effects", the true stiffness, damping and masses, the sensors' faults.
std::string truth_json(const Scenario& scenario);

}  // namespace framewatch::daemon
