#pragma once

#include <cstdint>
#include <span>

namespace framewatch::drivers {

enum class CanValue { integer, float32, float64 };

/// Where a number lies in a frame's data and what it means: physical = raw * factor + offset.
struct CanField {
  int start = 0;  ///< DBC bit number: of the lowest bit when little-endian, else of the highest
  int bits = 0;   ///< 1..64
  bool little_endian = true;
  bool is_signed = false;
  CanValue value = CanValue::integer;
  double factor = 1;
  double offset = 0;
};

/// Bits of the data that the field takes, as DBC bit numbers, from its lowest to its highest;
/// calls `take(bit)` for each.
template <typename Take>
void for_each_bit(const CanField& field, Take take) {
  if (field.little_endian) {
    for (int i = 0; i < field.bits; ++i) take(field.start + i);
    return;
  }
  // Big-endian: from the highest bit down through a byte, then the next byte's bit 7.
  const int highest = 8 * (field.start / 8) + 7 - field.start % 8;
  for (int i = field.bits - 1; i >= 0; --i) {
    const int at = highest + i;
    take(8 * (at / 8) + 7 - at % 8);
  }
}

/// Whether the field lies in `bytes` bytes of data.
bool fits(const CanField& field, int bytes);

/// Bit pattern of the field, zero-extended. Precondition: it fits.
std::uint64_t raw_bits(const CanField& field, std::span<const std::uint8_t> data);
/// The same as the whole number it stands for; of a floating field the nearest one.
std::int64_t raw_integer(const CanField& field, std::span<const std::uint8_t> data);
/// raw * factor + offset; NaN and infinity as the frame has them.
double physical(const CanField& field, std::span<const std::uint8_t> data);

/// Writes a bit pattern, or the nearest representable value (clamped to the field's range), into
/// the data.
void put_bits(const CanField& field, std::uint64_t raw, std::span<std::uint8_t> data);
void put_physical(const CanField& field, double value, std::span<std::uint8_t> data);

}  // namespace framewatch::drivers
