// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <framewatch/accel_counts_t.hpp>

#include "estimator/motion/sample.h"

namespace framewatch::drivers {

/// LCM channels of raw samples in the logs of the history.
inline constexpr const char* kCountsChannel = "COUNTS";
inline constexpr const char* kCountsTableChannel = "COUNTS_CHANNELS";

/// Special counts: no valid value, and a value beyond the range.
inline constexpr std::int32_t kNoCount = INT32_MIN;
inline constexpr std::int32_t kMaxCount = INT32_MAX;

/// Collects samples for one accel_counts_t. Call takes() before add(), then encode().
class CountBlock {
 public:
  explicit CountBlock(double resolution_mps2) { block_.resolution_mps2 = resolution_mps2; }

  bool empty() const { return block_.offset_us.empty(); }
  std::size_t size() const { return block_.offset_us.size(); }
  std::int64_t first_us() const { return block_.time_us; }
  /// Returns true if the block can represent the time of the sample.
  bool takes(const estimator::AccelSample& sample) const;
  void add(const estimator::AccelSample& sample);
  /// Returns the encoded message, valid until the next call, and empties the block.
  const std::vector<std::uint8_t>& encode();

 private:
  accel_counts_t block_{};
  std::vector<std::uint8_t> bytes_;
};

/// Returns the nearest number of counts; kNoCount for NaN, +-kMaxCount beyond the range.
std::int32_t count_of(double accel_mps2, double resolution_mps2);

/// Returns the encoded channel_table_t that names the channels 0, 1, ... of the blocks.
std::vector<std::uint8_t> count_table(const std::vector<std::string>& names, double rate_hz,
                                      std::int64_t time_us);

}  // namespace framewatch::drivers
