// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

/// [fleet]: the hub of `framewatch uplink`, docs/fleet.md. `framewatch run` ignores it.
struct FleetSettings {
  std::string building;             ///< its name at the hub
  std::vector<std::string> hubs;    ///< tls://HOST:PORT
  std::string certificate, key;     ///< certificate and key of this building, PEM
  std::string ca;                   ///< certificates that verify hubs, PEM
  std::vector<std::string> accept;  ///< commands of the hub to accept
  double raw_kbit_s = 2000;         ///< largest rate of requested raw samples
  bool send_config = false;
};

}  // namespace framewatch::daemon
