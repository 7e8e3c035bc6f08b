// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace framewatch::drivers {

/// Encodes an LCM message into `bytes`, reusing its memory.
template <typename Type>
void encode_into(std::vector<std::uint8_t>& bytes, const Type& message) {
  bytes.resize(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
}

/// Returns an LCM message as the bytes that are sent.
template <typename Type>
std::vector<std::uint8_t> encoded(const Type& message) {
  std::vector<std::uint8_t> bytes;
  encode_into(bytes, message);
  return bytes;
}

}  // namespace framewatch::drivers
