// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace framewatch::drivers::packets {

using Bytes = std::vector<std::uint8_t>;

inline void append(Bytes& out, const std::string& text) {
  out.insert(out.end(), text.begin(), text.end());
}

/// Returns `bytes` bytes of a number, big endian.
inline void append(Bytes& out, std::uint32_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

/// Returns a message in one datagram in the wire format of LCM.
inline Bytes whole(std::uint32_t sequence, const std::string& channel, const std::string& payload) {
  Bytes out;
  append(out, "LC02");
  append(out, sequence, 4);
  append(out, channel + '\0' + payload);
  return out;
}

/// Returns a datagram with a part of a message. `body` includes channel and NUL in part 0.
inline Bytes part(std::uint32_t sequence, std::uint32_t message_bytes, std::uint32_t offset,
                  std::uint32_t number, std::uint32_t parts, const std::string& body) {
  Bytes out;
  append(out, "LC03");
  append(out, sequence, 4);
  append(out, message_bytes, 4);
  append(out, offset, 4);
  append(out, number, 2);
  append(out, parts, 2);
  append(out, body);
  return out;
}

}  // namespace framewatch::drivers::packets
