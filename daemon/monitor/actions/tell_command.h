// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/monitor/service/service_manager.h"

namespace framewatch::daemon {

struct TellArguments {
  std::string config = kInstalledConfig;
  std::string message = "a test";
};

/// Runs `framewatch tell`: delivers an event of kind "test" to each receiver of [actions] and
/// prints what it answered. Returns the exit code: 1 when one of them fails.
int tell_command(const TellArguments& arguments);

}  // namespace framewatch::daemon
