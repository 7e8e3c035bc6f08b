#include "daemon/monitor/service/command_packet.h"

#include <algorithm>

#include "drivers/lcm/multicast/lcm_packet.h"

namespace framewatch::daemon {

CommandPacket refused(const std::string& why) {
  return {CommandPacket::kRefused, {why.begin(), why.end()}};
}

std::vector<std::uint8_t> packet_bytes(const CommandPacket& packet) {
  std::vector<std::uint8_t> out(packet.channel.begin(), packet.channel.end());
  out.push_back(0);
  out.insert(out.end(), packet.bytes.begin(), packet.bytes.end());
  return out;
}

std::optional<CommandPacket> packet_of(std::span<const std::uint8_t> bytes) {
  const auto end = std::find(bytes.begin(), bytes.end(), std::uint8_t{0});
  if (end == bytes.end() || end == bytes.begin() || bytes.size() > CommandPacket::kMaxBytes)
    return std::nullopt;
  if (end - bytes.begin() > std::ptrdiff_t{drivers::kLongestLcmChannel}) return std::nullopt;
  return CommandPacket{{bytes.begin(), end}, {end + 1, bytes.end()}};
}

}  // namespace framewatch::daemon
