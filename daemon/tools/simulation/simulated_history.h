// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "daemon/tools/simulation/simulation.h"

namespace framewatch::daemon {

/// Writes the history that `framewatch run` would keep of a scenario with a climate: a window
/// every two minutes whose values are the hour's truth and a normal error, without simulating any
/// motion. The history also keeps the weather. directory: of the history, new or empty.
/// weather_path: also writes the hours of the weather there (docs/years.md); empty: does not. step:
/// called with the number of hours done. Returns an empty string, or the problem.
std::string write_simulated_history(const Scenario& scenario, const std::string& directory,
                                    const std::string& weather_path,
                                    const std::function<void(std::int64_t done)>& step);

}  // namespace framewatch::daemon
