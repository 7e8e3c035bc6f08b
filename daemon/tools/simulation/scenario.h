// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/tools/simulation/simulation.h"

namespace framewatch::daemon {

/// Reads and validates a scenario file: the building as a configuration file has it ([structure],
/// [[channel]], or `config = "FILE"`), and what happens to it ([truth], [motion], [sensors],
/// [[sensor]], [[change]], [[effect]]). Empty optional and every problem at once when it is not
/// valid. Paths in the file are relative to it.
std::optional<Scenario> load_scenario(const std::string& path,
                                      std::vector<ConfigProblem>& problems);

/// Parses a scenario from a text. `path` is its name in messages and the start of relative paths.
/// `building`, if given, replaces the file of the key config.
std::optional<Scenario> read_scenario(const std::string& text, const std::string& path,
                                      std::vector<ConfigProblem>& problems,
                                      const Config* building = nullptr);

}  // namespace framewatch::daemon
