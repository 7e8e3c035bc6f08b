// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::fleet {

struct UplinkArguments {
  std::string config;
  std::string url;  ///< LCM provider; empty: as configured
  bool quiet = false;
};

/// Runs `framewatch uplink`: sends the history to the hub until SIGINT or SIGTERM. Returns the exit
/// status.
int uplink_command(const UplinkArguments& arguments);

}  // namespace framewatch::fleet
