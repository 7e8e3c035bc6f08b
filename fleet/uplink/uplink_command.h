#pragma once

#include <string>

namespace framewatch::fleet {

struct UplinkArguments {
  std::string config;
  std::string url;  ///< of LCM; empty: as configured
  bool quiet = false;
};

/// `framewatch uplink`: sends what the history holds to the hub, until a signal ends it. Returns
/// the exit status.
int uplink_command(const UplinkArguments& arguments);

}  // namespace framewatch::fleet
