#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"

namespace framewatch::daemon {

/// The result of one check of the machine.
struct MachineCheck {
  bool good = false;
  std::string name, found;
  std::string remedy = {};  ///< what to do about it; empty when it is good
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
  std::string config;           ///< whose LCM settings count; empty: the defaults
  std::string directory = ".";  ///< where state and records would go
  bool json = false;
};

/// framewatch selftest: whether this machine can carry a daemon, one line each. Exit code: 0 all
/// good, 1 not all, 2 bad configuration.
int selftest(const SelftestArguments& arguments);

}  // namespace framewatch::daemon
