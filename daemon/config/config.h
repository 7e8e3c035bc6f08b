// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/config/sections/config_problems.h"
#include "daemon/config/sections/settings.h"

namespace framewatch::daemon {

/// Reads and validates. Empty optional and every problem at once when it is not valid.
std::optional<Config> load_config(const std::string& path, std::vector<ConfigProblem>& problems);
/// Parses a configuration from a text. `path` is its name in messages.
std::optional<Config> parse_config(const std::string& path, const std::string& text,
                                   std::vector<ConfigProblem>& problems);

}  // namespace framewatch::daemon
