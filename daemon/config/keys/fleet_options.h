#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

/// [fleet]: the hub that `framewatch uplink` sends to, docs/fleet.md. `framewatch run` does not
/// look at it.
struct FleetSettings {
  std::string building;             ///< its name at the hub
  std::vector<std::string> hubs;    ///< tls://HOST:PORT
  std::string certificate, key;     ///< of this building, PEM
  std::string ca;                   ///< certificates that hubs are known by, PEM
  std::vector<std::string> accept;  ///< commands of the hub that are obeyed
  double raw_kbit_s = 2000;         ///< at most, of raw samples that were asked for
  bool send_config = false;
};

}  // namespace framewatch::daemon
