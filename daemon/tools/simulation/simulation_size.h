#pragma once

#include <string>

#include "daemon/tools/simulation/simulation.h"

namespace framewatch::daemon {

/// Why a scenario is too long or its building too large to be simulated; empty when it is not.
/// Reckoned before anything of that size is made.
std::string size_problem(const Scenario& scenario);

}  // namespace framewatch::daemon
