// SPDX-License-Identifier: MIT
#include "drivers/lcm/multicast/lcm_packet.h"

#include <algorithm>

#include <fmt/core.h>

#include "drivers/files/big_endian.h"

namespace framewatch::drivers {
namespace {

constexpr std::uint32_t kShort = 0x4c433032, kPart = 0x4c433033;
constexpr std::size_t kShortHeader = 8, kPartHeader = 20;

/// Removes the name of the channel and its NUL from `rest`. Returns false when there is no valid
/// name.
bool take_channel(std::span<const std::uint8_t>& rest, std::string_view& channel) {
  const auto end = std::find(rest.begin(), rest.end(), 0);
  const auto length = static_cast<std::size_t>(end - rest.begin());
  if (end == rest.end() || length == 0 || length > kLongestLcmChannel) return false;
  channel = {reinterpret_cast<const char*>(rest.data()), length};
  rest = rest.subspan(length + 1);
  return true;
}

std::optional<LcmPacket> whole_message(std::span<const std::uint8_t> datagram) {
  LcmPacket packet;
  packet.sequence = big_endian<std::uint32_t>(datagram.data() + 4);
  packet.payload = datagram.subspan(kShortHeader);
  if (!take_channel(packet.payload, packet.channel)) return std::nullopt;
  packet.message_bytes = static_cast<std::uint32_t>(packet.payload.size());
  return packet;
}

std::optional<LcmPacket> part_of_message(std::span<const std::uint8_t> datagram) {
  if (datagram.size() < kPartHeader) return std::nullopt;
  LcmPacket packet;
  packet.sequence = big_endian<std::uint32_t>(datagram.data() + 4);
  packet.message_bytes = big_endian<std::uint32_t>(datagram.data() + 8);
  packet.offset = big_endian<std::uint32_t>(datagram.data() + 12);
  packet.part = big_endian<std::uint16_t>(datagram.data() + 16);
  packet.parts = big_endian<std::uint16_t>(datagram.data() + 18);
  packet.payload = datagram.subspan(kPartHeader);
  if (packet.part >= packet.parts) return std::nullopt;
  if (packet.part == 0 && !take_channel(packet.payload, packet.channel)) return std::nullopt;
  if (packet.offset > packet.message_bytes ||
      packet.payload.size() > packet.message_bytes - packet.offset)
    return std::nullopt;
  return packet;
}

}  // namespace

std::optional<LcmPacket> parse_lcm_packet(std::span<const std::uint8_t> datagram) {
  if (datagram.size() < kShortHeader) return std::nullopt;
  const std::uint32_t magic = big_endian<std::uint32_t>(datagram.data());
  if (magic == kShort) return whole_message(datagram);
  if (magic == kPart) return part_of_message(datagram);
  return std::nullopt;
}

std::string to_text(const LcmSender& sender) {
  const std::uint32_t a = sender.address;
  return fmt::format("{}.{}.{}.{}:{}", a >> 24, a >> 16 & 255, a >> 8 & 255, a & 255, sender.port);
}

}  // namespace framewatch::drivers
