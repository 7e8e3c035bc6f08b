// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace framewatch::drivers {

/// The sender of a message: IPv4 address and UDP port in host byte order. Both are 0 when the
/// provider does not know the sender, as memq:// and event logs.
struct LcmSender {
  std::uint32_t address = 0;
  std::uint16_t port = 0;
  friend auto operator<=>(const LcmSender&, const LcmSender&) = default;
};

/// Returns a sender for messages: "10.0.0.7:41230".
std::string to_text(const LcmSender& sender);

/// Longest name of a channel, bytes.
inline constexpr std::size_t kLongestLcmChannel = 63;

/// One datagram of LCM's UDP multicast protocol, big endian. A message that fits into a datagram is
/// "LC02", sequence (4 bytes), channel, NUL, payload. A part of a longer one is "LC03", sequence,
/// size of the whole payload, offset of this part in it (4 bytes each), number of this part, number
/// of parts (2 bytes each). Then follow channel and NUL, in part 0 only, and the part of the
/// payload.
struct LcmPacket {
  std::uint32_t sequence = 0;
  std::uint32_t message_bytes = 0;  ///< size of the whole payload
  std::uint32_t offset = 0;
  std::uint16_t part = 0, parts = 1;
  std::string_view channel;  ///< empty in every part but 0
  std::span<const std::uint8_t> payload;
};

/// Parses a datagram, to which the result refers. Returns nullopt unless every length agrees with
/// the size of the datagram and the part lies within its message.
std::optional<LcmPacket> parse_lcm_packet(std::span<const std::uint8_t> datagram);

}  // namespace framewatch::drivers
