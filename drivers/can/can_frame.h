// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace framewatch::drivers {

/// One frame as it was on the bus, with the receive stamp of the host.
struct CanFrame {
  std::int64_t stamp_us = 0;  ///< host clock (UTC), microseconds
  std::uint32_t id = 0;       ///< 11 or 29 bits; class bits in an error frame
  bool extended = false;
  bool remote = false;
  bool error = false;  ///< made by the kernel to report the state of the bus
  bool fd = false;
  bool bit_rate_switch = false;
  std::uint8_t length = 0;  ///< bytes of data
  std::array<std::uint8_t, 64> data{};
};

/// Returns true if a CAN FD frame can carry exactly this many bytes.
constexpr bool is_fd_length(int bytes) {
  return (bytes >= 0 && bytes <= 8) || bytes == 12 || bytes == 16 || bytes == 20 || bytes == 24 ||
         bytes == 32 || bytes == 48 || bytes == 64;
}

enum class CanValue { integer, float32, float64 };

/// The place of a number in the data of a frame and its meaning: physical = raw * factor + offset.
struct CanField {
  int start = 0;  ///< DBC bit number: of the lowest bit when little-endian, else of the highest
  int bits = 0;   ///< 1..64
  bool little_endian = true;
  bool is_signed = false;
  CanValue value = CanValue::integer;
  double factor = 1;
  double offset = 0;
};

/// Whole numbers from `least` to `most`.
struct ValueRange {
  std::uint64_t least = 0, most = 0;
  bool operator==(const ValueRange&) const = default;
};

/// A multiplexor of a message: other fields are in a frame only while this one has a certain value.
struct CanSwitch {
  CanField field;                  ///< a whole number; its bits count, without sign and factor
  std::vector<ValueRange> values;  ///< values at which the other fields are in the frame
};

/// Calls `take(bit)` for each bit of the field, from its lowest to its highest. `bit` is a DBC bit
/// number.
template <typename Take>
void for_each_bit(const CanField& field, Take take) {
  if (field.little_endian) {
    for (int i = 0; i < field.bits; ++i) take(field.start + i);
    return;
  }
  // Big-endian: from the highest bit down through a byte, then bit 7 of the next byte.
  const int highest = 8 * (field.start / 8) + 7 - field.start % 8;
  for (int i = field.bits - 1; i >= 0; --i) {
    const int at = highest + i;
    take(8 * (at / 8) + 7 - at % 8);
  }
}

/// Returns true if the field lies within `bytes` bytes of data.
bool fits(const CanField& field, int bytes);

/// Returns the bit pattern of the field, zero-extended. Precondition: the field fits.
std::uint64_t raw_bits(const CanField& field, std::span<const std::uint8_t> data);
/// Returns the field as a whole number, without factor and offset; the nearest one for a floating
/// field.
std::int64_t raw_integer(const CanField& field, std::span<const std::uint8_t> data);
/// Returns raw * factor + offset. NaN and infinity in the frame are returned unchanged.
double physical(const CanField& field, std::span<const std::uint8_t> data);

/// Returns true if the switch has one of its values. Precondition: its field fits.
bool is_on(const CanSwitch& multiplexor, std::span<const std::uint8_t> data);

/// Writes a bit pattern into the data.
void put_bits(const CanField& field, std::uint64_t raw, std::span<std::uint8_t> data);
/// Writes the nearest value that the field can represent, clamped to its range.
void put_physical(const CanField& field, double value, std::span<std::uint8_t> data);

}  // namespace framewatch::drivers
