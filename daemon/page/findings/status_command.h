#pragma once

#include <string>

#include "daemon/monitor/service/service_manager.h"

namespace framewatch::daemon {

struct StatusArguments {
  std::string config = kInstalledConfig;
  std::string url;  ///< LCM provider; empty: the configuration's
  bool json = false;
};

/// framewatch status: whether the running daemon is well, and what is not. Exit code: 0 well, 1 not
/// well, 2 nothing is heard of it, or bad configuration.
int status_command(const StatusArguments& arguments);

}  // namespace framewatch::daemon
