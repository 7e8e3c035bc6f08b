#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <framewatch/accel_counts_t.hpp>

#include "estimator/motion/sample.h"

namespace framewatch::drivers {

/// LCM channels of raw samples in the logs of a history.
inline constexpr const char* kCountsChannel = "COUNTS";
inline constexpr const char* kCountsTableChannel = "COUNTS_CHANNELS";

/// Counts with a meaning of their own: no valid value; beyond the range.
inline constexpr std::int32_t kNoCount = INT32_MIN;
inline constexpr std::int32_t kMaxCount = INT32_MAX;

/// Collects samples for one accel_counts_t.
class CountBlock {
 public:
  explicit CountBlock(double resolution_mps2) { block_.resolution_mps2 = resolution_mps2; }

  bool empty() const { return block_.offset_us.empty(); }
  std::size_t size() const { return block_.offset_us.size(); }
  std::int64_t first_us() const { return block_.time_us; }
  /// Whether the sample's time can be said in this block.
  bool takes(const estimator::AccelSample& sample) const;
  void add(const estimator::AccelSample& sample);
  /// The message; the block is empty afterwards.
  const std::vector<std::uint8_t>& encode();

 private:
  accel_counts_t block_{};
  std::vector<std::uint8_t> bytes_;
};

/// The number of counts nearest to a value.
std::int32_t count_of(double accel_mps2, double resolution_mps2);

/// The table that names the channels 0, 1, ... of the blocks, encoded.
std::vector<std::uint8_t> count_table(const std::vector<std::string>& names, double rate_hz,
                                      std::int64_t time_us);

}  // namespace framewatch::drivers
