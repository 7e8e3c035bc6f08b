#include "drivers/accel_codec.h"

#include <framewatch/accel_t.hpp>

namespace framewatch::drivers {

std::optional<NodeSample> decode_accel(const void* data, std::size_t size) {
  accel_t message{};
  if (size != kAccelBytes) return std::nullopt;
  if (message.decode(data, 0, static_cast<int>(size)) != static_cast<int>(size))
    return std::nullopt;
  if (message.time_us > kLatestTime_us || message.time_us < -kLatestTime_us) return std::nullopt;
  NodeSample sample{from_microseconds(message.time_us), message.sequence, message.node, {}};
  for (std::size_t i = 0; i < 3; ++i) sample.accel_abs_mps2[i] = message.accel_abs_mps2[i];
  return sample;
}

std::vector<std::uint8_t> encode_accel(const NodeSample& sample) {
  accel_t message{};
  message.time_us = to_microseconds(sample.time);
  message.sequence = sample.sequence;
  message.node = sample.node;
  for (std::size_t i = 0; i < 3; ++i) message.accel_abs_mps2[i] = sample.accel_abs_mps2[i];
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace framewatch::drivers
