#pragma once

#include <string>

namespace framewatch::daemon {

/// [commands]: how running daemons are told what to do, docs/operate.md.
struct CommandSettings {
  std::string directory;  ///< of the sockets; empty: command_directories() says
};

}  // namespace framewatch::daemon
