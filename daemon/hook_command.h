#pragma once

#include <string>
#include <utility>
#include <vector>

#include "daemon/action_way.h"

namespace framewatch::daemon {

/// FRAMEWATCH_* of an event, for the environment of a program.
std::vector<std::pair<std::string, std::string>> event_environment(const event_t& event,
                                                                   const std::string& building);

/// Runs settings.command once, in a process group of its own, and waits for it. `input` is its
/// standard input; what it writes is kept for the trouble. Whoever takes longer than
/// command_timeout_s is ended with his group.
Told run_hook(const ActionSettings& settings, const std::string& input,
              const std::vector<std::pair<std::string, std::string>>& environment,
              const Abandoned& abandoned);

}  // namespace framewatch::daemon
