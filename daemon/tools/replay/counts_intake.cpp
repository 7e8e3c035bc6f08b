// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/counts_intake.h"

#include <algorithm>
#include <cmath>

#include <framewatch/accel_counts_t.hpp>

#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/count_block.h"
#include "drivers/lcm/message_check.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {

bool is_of_raw_log(const std::string& channel) {
  return channel == drivers::kCountsChannel || channel == drivers::kCountsTableChannel;
}

drivers::IntakeResult CountsIntake::table(std::span<const std::uint8_t> data) {
  const auto table = drivers::decode_channel_table(data.data(), data.size());
  if (!table) return drivers::IntakeResult::malformed;
  rate_hz_ = table->rate_hz;
  place_.clear();
  unknown_.clear();
  std::vector<bool> found(axes_.size(), false);
  for (const drivers::ChannelTable::Entry& entry : table->entries) {
    const auto at = std::find(axes_.begin(), axes_.end(), entry.name);
    place_.push_back(at == axes_.end() ? -1 : static_cast<int>(at - axes_.begin()));
    if (at == axes_.end())
      unknown_.push_back(entry.name);
    else
      found[static_cast<std::size_t>(at - axes_.begin())] = true;
  }
  missing_.clear();
  for (std::size_t a = 0; a < axes_.size(); ++a)
    if (!found[a]) missing_.push_back(axes_[a]);
  return drivers::IntakeResult::table;
}

drivers::IntakeResult CountsIntake::message(const std::string& channel,
                                            std::span<const std::uint8_t> data, const Sink& sink) {
  if (channel == drivers::kCountsTableChannel) return table(data);
  const auto block = drivers::decoded<accel_counts_t>(data);
  if (!block || place_.empty() || !(block->resolution_mps2 > 0) ||
      !std::isfinite(block->resolution_mps2))
    return drivers::IntakeResult::malformed;
  for (std::size_t i = 0; i < block->count.size(); ++i) {
    const auto at = static_cast<std::size_t>(block->channel[i]);
    if (at >= place_.size() || place_[at] < 0) continue;
    std::int64_t time_us = 0;
    if (__builtin_add_overflow(block->time_us, block->offset_us[i], &time_us)) continue;
    const std::int32_t count = block->count[i];
    sink({estimator::from_microseconds(time_us), place_[at],
          count == drivers::kNoCount ? estimator::kNaN : count * block->resolution_mps2});
  }
  return drivers::IntakeResult::samples;
}

}  // namespace framewatch::daemon
