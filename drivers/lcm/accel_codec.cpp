#include "drivers/lcm/accel_codec.h"

#include <bit>
#include <cstring>

#include <framewatch/accel_t.hpp>
#include <framewatch/message_layouts.hpp>

#include "drivers/files/encoded.h"

namespace framewatch::drivers {
namespace {

// lcm-gen's own decoder takes as long as one shift of the window of a small building, so the fields
// are read where they lie in the payload.
static_assert(std::endian::native == std::endian::little && sizeof(double) == 8);
constexpr std::size_t kTimeAt = offset_of(kAccelFields, "time_us"),
                      kSequenceAt = offset_of(kAccelFields, "sequence"),
                      kNodeAt = offset_of(kAccelFields, "node"),
                      kAccelAt = offset_of(kAccelFields, "accel_abs_mps2");
static_assert(kAccelAt + 3 * 8 == kAccelBytes);

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

std::optional<SensorNodeSample> decode_accel(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  if (!is_accel(bytes, size)) return std::nullopt;
  const auto time_us = static_cast<std::int64_t>(big_endian_64(bytes + kTimeAt));
  if (time_us > kLatestTime_us || time_us < -kLatestTime_us) return std::nullopt;
  SensorNodeSample sample{estimator::from_microseconds(time_us),
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

std::vector<std::uint8_t> encode_accel(const SensorNodeSample& sample) {
  accel_t message{};
  message.time_us = to_microseconds(sample.time);
  message.sequence = sample.sequence;
  message.node = sample.node;
  for (std::size_t i = 0; i < 3; ++i) message.accel_abs_mps2[i] = sample.accel_abs_mps2[i];
  return encoded(message);
}

}  // namespace framewatch::drivers
