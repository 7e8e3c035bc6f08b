#include "drivers/accel_codec.h"

#include <bit>
#include <cstring>

#include <framewatch/accel_t.hpp>

#include "drivers/encoded.h"

namespace framewatch::drivers {
namespace {

// lcm-gen's own decoder costs as much as a shift of a small building: fingerprint, time, sequence,
// node and three axes are read here where they lie.
static_assert(std::endian::native == std::endian::little && sizeof(double) == 8);
constexpr std::size_t kTimeAt = 8, kSequenceAt = 16, kNodeAt = 24, kAccelAt = 28;

std::uint64_t big_endian_64(const std::uint8_t* bytes) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return __builtin_bswap64(value);
}

std::uint32_t big_endian_32(const std::uint8_t* bytes) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return __builtin_bswap32(value);
}

bool is_accel(const std::uint8_t* bytes, std::size_t size) {
  static const auto fingerprint = static_cast<std::uint64_t>(accel_t::getHash());
  return size == kAccelBytes && big_endian_64(bytes) == fingerprint;
}

}  // namespace

std::optional<NodeSample> decode_accel(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  if (!is_accel(bytes, size)) return std::nullopt;
  const auto time_us = static_cast<std::int64_t>(big_endian_64(bytes + kTimeAt));
  if (time_us > kLatestTime_us || time_us < -kLatestTime_us) return std::nullopt;
  NodeSample sample{from_microseconds(time_us),
                    static_cast<std::int64_t>(big_endian_64(bytes + kSequenceAt)),
                    static_cast<std::int32_t>(big_endian_32(bytes + kNodeAt)),
                    {}};
  for (std::size_t i = 0; i < 3; ++i)
    sample.accel_abs_mps2[i] = std::bit_cast<double>(big_endian_64(bytes + kAccelAt + 8 * i));
  return sample;
}

std::optional<std::int64_t> accel_time_us(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  if (!is_accel(bytes, size)) return std::nullopt;
  return static_cast<std::int64_t>(big_endian_64(bytes + kTimeAt));
}

std::vector<std::uint8_t> encode_accel(const NodeSample& sample) {
  accel_t message{};
  message.time_us = to_microseconds(sample.time);
  message.sequence = sample.sequence;
  message.node = sample.node;
  for (std::size_t i = 0; i < 3; ++i) message.accel_abs_mps2[i] = sample.accel_abs_mps2[i];
  return encoded(message);
}

}  // namespace framewatch::drivers
