// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"

namespace framewatch::daemon {

/// Result of one check of the machine.
struct MachineCheck {
  bool good = false;
  std::string name, found;
  std::string remedy = {};  ///< what to do; empty if the check is good
};

/// Checks that LCM delivers messages published on this machine.
MachineCheck check_multicast(const LcmSettings& lcm);
/// Checks that the kernel grants the requested receive buffer.
MachineCheck check_buffer(const LcmSettings& lcm);
/// Checks that the system clock is synchronised.
MachineCheck check_clock();
/// Checks the estimate of a virtual building against its true stiffnesses.
MachineCheck check_estimate();
/// Checks that a file can be written under `directory` quickly, and that there is enough space.
MachineCheck check_disk(const std::string& directory);

struct SelftestArguments {
  std::string config;           ///< file with the LCM settings; empty for the defaults
  std::string directory = ".";  ///< folder for state and records
  bool json = false;
};

/// Runs `framewatch selftest`: checks if this machine can run a daemon, one line per check. Returns
/// 0 if all are good, 1 if not, 2 for a bad configuration.
int selftest(const SelftestArguments& arguments);

}  // namespace framewatch::daemon
