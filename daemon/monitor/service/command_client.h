#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/config/sections/settings.h"

namespace framewatch::daemon {

/// A command to a running daemon, or its answer: an LCM message under the name of its channel
/// without the prefix. It travels as one packet: the name, a zero byte, the message.
struct CommandPacket {
  static constexpr std::size_t kMaxBytes = 65536;  ///< of a packet
  static constexpr const char* kRefused = "REFUSED";

  std::string channel;  ///< kRefused: the bytes are a sentence that says why
  std::vector<std::uint8_t> bytes;
};

CommandPacket refused(const std::string& why);

std::vector<std::uint8_t> packet_bytes(const CommandPacket& packet);
/// Empty when these bytes are no packet.
std::optional<CommandPacket> packet_of(std::span<const std::uint8_t> bytes);

/// Where a daemon started by this process' user listens for commands: [commands] directory, or the
/// RuntimeDirectory of its systemd unit, or a directory of the user's own.
std::string command_directory(const Config& config);

/// Where its clients look for it, in this order.
std::vector<std::string> command_directories(const Config& config);

/// Makes the directory where it is missing. Empty, or why nobody should listen there: it must be a
/// directory, no link, of this user or root, that nobody else can put files into.
std::string prepare_command_directory(const std::string& directory);

/// Of the socket of "run" or "record" in a directory: two daemons with different prefixes have two.
std::string command_path(const std::string& directory, const Config& config,
                         const std::string& service);

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
