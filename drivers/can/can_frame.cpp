// SPDX-License-Identifier: MIT
#include "drivers/can/can_frame.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

namespace framewatch::drivers {
namespace {

double integer_value(const CanField& field, std::uint64_t raw) {
  if (!field.is_signed) return static_cast<double>(raw);
  const int unused = 64 - field.bits;
  return static_cast<double>(static_cast<std::int64_t>(raw << unused) >> unused);
}

/// Returns the bit pattern of the nearest whole number that the field can hold.
std::uint64_t clamped(const CanField& field, double value) {
  if (!(value == value)) value = 0;
  const double span = std::ldexp(1.0, field.bits);
  if (field.is_signed) {
    const double half = span / 2;
    if (value >= half - 1) return (std::uint64_t{1} << (field.bits - 1)) - 1;
    if (value <= -half) return std::uint64_t{1} << (field.bits - 1);
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::nearbyint(value)));
  }
  if (value >= span - 1) return ~std::uint64_t{0};
  return value <= 0 ? 0 : static_cast<std::uint64_t>(std::nearbyint(value));
}

}  // namespace

bool fits(const CanField& field, int bytes) {
  if (field.bits < 1 || field.bits > 64 || field.start < 0 || field.start >= 8 * bytes)
    return false;
  if (field.little_endian) return field.start + field.bits <= 8 * bytes;
  const int highest = 8 * (field.start / 8) + 7 - field.start % 8;
  return highest + field.bits <= 8 * bytes;
}

std::uint64_t raw_bits(const CanField& field, std::span<const std::uint8_t> data) {
  std::uint64_t raw = 0;
  int place = 0;
  for_each_bit(field, [&](int bit) {
    const unsigned byte = data[static_cast<std::size_t>(bit / 8)];
    raw |= static_cast<std::uint64_t>((byte >> (bit % 8)) & 1u) << place++;
  });
  return raw;
}

std::int64_t raw_integer(const CanField& field, std::span<const std::uint8_t> data) {
  constexpr double kLargest = 9e18;
  const std::uint64_t raw = raw_bits(field, data);
  if (field.value == CanValue::integer) {
    const int unused = 64 - field.bits;
    if (field.is_signed) return static_cast<std::int64_t>(raw << unused) >> unused;
    return static_cast<std::int64_t>(raw);
  }
  const double value = field.value == CanValue::float64
                           ? std::bit_cast<double>(raw)
                           : std::bit_cast<float>(static_cast<std::uint32_t>(raw));
  return std::isfinite(value) ? std::llround(std::clamp(value, -kLargest, kLargest)) : 0;
}

double physical(const CanField& field, std::span<const std::uint8_t> data) {
  const std::uint64_t raw = raw_bits(field, data);
  double value = 0;
  switch (field.value) {
    case CanValue::integer:
      value = integer_value(field, raw);
      break;
    case CanValue::float32:
      value = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
      break;
    case CanValue::float64:
      value = std::bit_cast<double>(raw);
      break;
  }
  return value * field.factor + field.offset;
}

bool is_on(const CanSwitch& multiplexor, std::span<const std::uint8_t> data) {
  const std::uint64_t value = raw_bits(multiplexor.field, data);
  return std::any_of(
      multiplexor.values.begin(), multiplexor.values.end(),
      [&](const ValueRange& range) { return value >= range.least && value <= range.most; });
}

void put_bits(const CanField& field, std::uint64_t raw, std::span<std::uint8_t> data) {
  int place = 0;
  for_each_bit(field, [&](int bit) {
    std::uint8_t& byte = data[static_cast<std::size_t>(bit / 8)];
    const auto mask = static_cast<std::uint8_t>(1u << (bit % 8));
    const bool set = ((raw >> place++) & 1u) != 0;
    byte = static_cast<std::uint8_t>(set ? byte | mask : byte & ~mask);
  });
}

void put_physical(const CanField& field, double value, std::span<std::uint8_t> data) {
  const double raw = (value - field.offset) / field.factor;
  switch (field.value) {
    case CanValue::integer:
      return put_bits(field, clamped(field, raw), data);
    case CanValue::float32:
      return put_bits(field, std::bit_cast<std::uint32_t>(static_cast<float>(raw)), data);
    case CanValue::float64:
      return put_bits(field, std::bit_cast<std::uint64_t>(raw), data);
  }
}

}  // namespace framewatch::drivers
