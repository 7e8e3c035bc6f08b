// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/tools/commands/check_report.h"

namespace framewatch::daemon {

/// Returns several lines for people, without the warnings.
std::string to_text(const CheckReport& report);
/// Returns JSON of schema framewatch.check/1. `report` is empty if there are problems.
std::string to_json(const std::string& path, const std::optional<CheckReport>& report,
                    const std::vector<ConfigProblem>& problems);

}  // namespace framewatch::daemon
