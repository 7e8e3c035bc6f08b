// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/config/sections/settings.h"

namespace framewatch::daemon {

/// A command to a running daemon, or its answer: an LCM message and the name of its channel without
/// the prefix. It travels as one packet: the name, a zero byte, the message.
struct CommandPacket {
  static constexpr std::size_t kMaxBytes = 65536;  ///< bytes of a packet
  static constexpr const char* kRefused = "REFUSED";

  std::string channel;  ///< kRefused: `bytes` is a sentence that says why
  std::vector<std::uint8_t> bytes;
};

/// Makes the answer that refuses a command. `why` is a sentence.
CommandPacket refused(const std::string& why);

std::vector<std::uint8_t> packet_bytes(const CommandPacket& packet);
/// Parses a packet. Returns nullopt if the bytes are not a packet.
std::optional<CommandPacket> packet_of(std::span<const std::uint8_t> bytes);

/// Returns the directory in which a daemon of this process' user listens: [commands] directory,
/// else the RuntimeDirectory of its systemd unit, else a private directory of the user.
std::string command_directory(const Config& config);

/// Returns the directories in which a client looks for the daemon, in this order.
std::vector<std::string> command_directories(const Config& config);

/// Creates the directory if necessary and checks that it is safe to listen there: a real directory
/// of this user or root in which no other user can create files. Returns an empty string, or the
/// problem.
std::string prepare_command_directory(const std::string& directory);

/// Returns the path of the socket of `service` ("run" or "record") in a directory. Daemons with
/// different prefixes have different sockets.
std::string command_path(const std::string& directory, const Config& config,
                         const std::string& service);

struct CommandAnswer {
  bool answered = false;  ///< a daemon answered, perhaps with a refusal
  std::string problem;    ///< why the daemon did not answer or refused; empty on success
  std::vector<std::uint8_t> bytes = {};  ///< the message that answers the command
};

/// Sends a command to the daemon of this configuration (`service`: "run" or "record") and waits at
/// most 10 s for the answer. CommandAnswer::problem says what to do about a failure.
CommandAnswer give_command(const Config& config, const std::string& service,
                           const CommandPacket& command);

}  // namespace framewatch::daemon
