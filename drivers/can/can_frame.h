#pragma once

#include <array>
#include <cstdint>

namespace framewatch::drivers {

/// One frame as it was on the bus, with the host's receive stamp.
struct CanFrame {
  std::int64_t stamp_us = 0;  ///< host clock (UTC), microseconds
  std::uint32_t id = 0;       ///< 11 or 29 bits; of an error frame its class bits
  bool extended = false;
  bool remote = false;
  bool error = false;  ///< the kernel tells of the bus, nobody sent it
  bool fd = false;
  bool bit_rate_switch = false;
  std::uint8_t length = 0;  ///< bytes of data
  std::array<std::uint8_t, 64> data{};
};

/// Whether a CAN FD frame can carry exactly this many bytes.
constexpr bool is_fd_length(int bytes) {
  return (bytes >= 0 && bytes <= 8) || bytes == 12 || bytes == 16 || bytes == 20 || bytes == 24 ||
         bytes == 32 || bytes == 48 || bytes == 64;
}

}  // namespace framewatch::drivers
