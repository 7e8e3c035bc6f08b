#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

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

}  // namespace framewatch::daemon
