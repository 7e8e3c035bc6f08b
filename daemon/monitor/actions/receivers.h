// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "daemon/monitor/actions/notifier.h"

namespace framewatch::daemon {

/// Returns the FRAMEWATCH_* variables of an event, for the environment of a program.
std::vector<std::pair<std::string, std::string>> event_environment(const event_t& event,
                                                                   const std::string& building);

/// Runs settings.command once, in a separate process group, and waits for it. `input` is its
/// standard input. If it fails, the result holds its last line of output. A command that takes
/// longer than command_timeout_s is killed with its group.
DeliveryResult run_hook(const ActionSettings& settings, const std::string& input,
                        const std::vector<std::pair<std::string, std::string>>& environment,
                        const Abandoned& abandoned);

}  // namespace framewatch::daemon
