#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/config/sections/settings.h"
#include "daemon/monitor/service/command_packet.h"

namespace framewatch::daemon {

/// What became of a command.
struct CommandAnswer {
  bool answered = false;            ///< a daemon answered, if only to refuse
  std::string problem;              ///< why there is no answer, or why it was refused; else empty
  std::vector<std::uint8_t> bytes;  ///< the message that answers it
};

/// Gives a command to the daemon of this configuration, "run" or "record", and waits for the
/// answer, 10 s at most. The problem says in plain words what to do about it.
CommandAnswer give_command(const Config& config, const std::string& service,
                           const CommandPacket& command);

}  // namespace framewatch::daemon
