#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/motion/sample.h"

namespace framewatch::drivers {

/// One accelerometer node at one instant, as accel_t carries it.
struct SensorNodeSample {
  estimator::Time time;
  std::int64_t sequence = 0;
  std::int32_t node = 0;
  std::array<double, 3> accel_abs_mps2{};  ///< x, y, z; NaN where there is no valid value
};

/// Bytes of one encoded accel_t.
inline constexpr std::size_t kAccelBytes = 52;

/// Times beyond this, 285 years either way, are refused: arithmetic on the others stays exact.
inline constexpr std::int64_t kLatestTime_us = std::int64_t{1} << 53;

/// Empty unless `size` and fingerprint are exactly those of accel_t and the time is within
/// kLatestTime_us.
std::optional<SensorNodeSample> decode_accel(const void* data, std::size_t size);
/// The stamp alone, microseconds; empty when the fingerprint or the size is not accel_t's.
std::optional<std::int64_t> accel_time_us(const void* data, std::size_t size);
std::vector<std::uint8_t> encode_accel(const SensorNodeSample& sample);

}  // namespace framewatch::drivers
