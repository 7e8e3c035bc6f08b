#pragma once

#include <vector>

#include "daemon/base/toml_document.h"
#include "daemon/tools/simulation/simulation.h"

namespace framewatch::daemon {

/// [sensors] (null when absent), which holds for every axis of scenario.config, and the [[sensor]]
/// tables, each for the channel it names, into scenario.sensors and scenario.noise_ratio.
void read_sensors(const TomlValue* all, const std::vector<const TomlValue*>& single,
                  Scenario& scenario, std::vector<TextProblem>& problems);

}  // namespace framewatch::daemon
