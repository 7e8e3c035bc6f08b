// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>

namespace framewatch::drivers {

/// Reads a 2, 4 or 8 byte integer whose most significant byte comes first. `bytes` has at least as
/// many.
template <std::integral Integer>
Integer big_endian(const std::uint8_t* bytes) {
  Integer value = 0;
  std::memcpy(&value, bytes, sizeof value);
  if constexpr (std::endian::native == std::endian::big) return value;
  if constexpr (sizeof value == 2)
    return static_cast<Integer>(__builtin_bswap16(static_cast<std::uint16_t>(value)));
  if constexpr (sizeof value == 4)
    return static_cast<Integer>(__builtin_bswap32(static_cast<std::uint32_t>(value)));
  return static_cast<Integer>(__builtin_bswap64(static_cast<std::uint64_t>(value)));
}

}  // namespace framewatch::drivers
