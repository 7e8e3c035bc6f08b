#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace framewatch::drivers {

/// Longest name of a channel, bytes.
inline constexpr std::size_t kLongestLcmChannel = 63;

/// One datagram of LCM's UDP multicast protocol, big endian. A message that fits in one datagram is
/// "LC02", sequence (4 bytes), channel, NUL, payload; a part of a longer one is "LC03", sequence,
/// size of the whole payload, offset of this part in it (4 bytes each), number of this part, number
/// of parts (2 bytes each), and in part 0 channel and NUL, then the part of the payload.
struct LcmPacket {
  std::uint32_t sequence = 0;
  std::uint32_t message_bytes = 0;  ///< of the whole payload
  std::uint32_t offset = 0;
  std::uint16_t part = 0, parts = 1;
  std::string_view channel;  ///< empty in every part but 0
  std::span<const std::uint8_t> payload;
};

/// Empty unless every length in the datagram agrees with it and the part lies within its message.
/// What it refers to is `datagram`.
std::optional<LcmPacket> parse_lcm_packet(std::span<const std::uint8_t> datagram);

}  // namespace framewatch::drivers
