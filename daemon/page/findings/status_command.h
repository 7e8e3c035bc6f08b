// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/monitor/service/service_manager.h"

namespace framewatch::daemon {

struct StatusArguments {
  std::string config = kInstalledConfig;
  std::string url;  ///< LCM provider; empty: the configuration's
  bool json = false;
};

/// Runs `framewatch status`: listens to the running daemon and prints its state and problems.
/// Returns the exit status: 0 healthy, 1 problems found, 2 no daemon heard or bad configuration.
int status_command(const StatusArguments& arguments);

}  // namespace framewatch::daemon
