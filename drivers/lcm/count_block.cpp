// SPDX-License-Identifier: MIT
#include "drivers/lcm/count_block.h"

#include <cmath>

#include <framewatch/channel_table_t.hpp>

#include "drivers/files/encoded.h"

namespace framewatch::drivers {

std::int32_t count_of(double accel_mps2, double resolution_mps2) {
  if (std::isnan(accel_mps2)) return kNoCount;
  const double counts = std::round(accel_mps2 / resolution_mps2);
  if (counts >= kMaxCount) return kMaxCount;
  if (counts <= -double{kMaxCount}) return -kMaxCount;
  return static_cast<std::int32_t>(counts);
}

bool CountBlock::takes(const estimator::AccelSample& sample) const {
  std::int64_t offset_us = 0;
  return empty() ||
         (!__builtin_sub_overflow(to_microseconds(sample.time), block_.time_us, &offset_us) &&
          offset_us >= INT32_MIN && offset_us <= INT32_MAX);
}

void CountBlock::add(const estimator::AccelSample& sample) {
  if (empty()) block_.time_us = to_microseconds(sample.time);
  block_.offset_us.push_back(
      static_cast<std::int32_t>(to_microseconds(sample.time) - block_.time_us));
  block_.channel.push_back(static_cast<std::int16_t>(sample.axis));
  block_.count.push_back(count_of(sample.accel, block_.resolution_mps2));
}

const std::vector<std::uint8_t>& CountBlock::encode() {
  block_.samples = static_cast<std::int32_t>(block_.offset_us.size());
  encode_into(bytes_, block_);
  block_.offset_us.clear();
  block_.channel.clear();
  block_.count.clear();
  return bytes_;
}

std::vector<std::uint8_t> count_table(const std::vector<std::string>& names, double rate_hz,
                                      std::int64_t time_us) {
  channel_table_t table{};
  table.time_us = time_us;
  table.rate_hz = rate_hz;
  table.channels = static_cast<std::int32_t>(names.size());
  table.name = names;
  table.node.resize(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) table.node[i] = static_cast<std::int32_t>(i);
  table.axis.assign(names.size(), 0);
  return encoded(table);
}

}  // namespace framewatch::drivers
