#pragma once

#include <string>
#include <vector>

#include "daemon/config.h"

namespace framewatch::daemon {

/// What one look at the machine found.
struct MachineCheck {
  bool good = false;
  std::string name, found;
  std::string remedy = {};  ///< what to do about it; empty when it is good
};

/// LCM delivers to this machine what is published on it.
MachineCheck check_multicast(const LcmSettings& lcm);
/// The kernel gives the receive buffer that is asked for.
MachineCheck check_buffer(const LcmSettings& lcm);
/// The clock of the day is kept right by somebody.
MachineCheck check_clock();
/// A virtual building is estimated, and its stiffnesses are those it has.
MachineCheck check_estimate();
/// A file can be written to the disk under `directory`, soon, and there is room.
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
