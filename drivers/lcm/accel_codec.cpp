// SPDX-License-Identifier: MIT
#include "drivers/lcm/accel_codec.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include <framewatch/accel_t.hpp>
#include <framewatch/channel_table_t.hpp>
#include <framewatch/message_layouts.hpp>

#include "drivers/files/big_endian.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::drivers {
namespace {

// The decoder of lcm-gen takes as long as one shift of the window of a small building, so the
// fields are read at their places in the payload.
static_assert(std::endian::native == std::endian::little && sizeof(double) == 8);
constexpr std::size_t kTimeAt = offset_of(kAccelFields, "time_us"),
                      kSequenceAt = offset_of(kAccelFields, "sequence"),
                      kNodeAt = offset_of(kAccelFields, "node"),
                      kAccelAt = offset_of(kAccelFields, "accel_abs_mps2");
static_assert(kAccelAt + 3 * 8 == kAccelBytes);

bool is_accel(const std::uint8_t* bytes, std::size_t size) {
  static const auto fingerprint = static_cast<std::uint64_t>(accel_t::getHash());
  return size == kAccelBytes && big_endian<std::uint64_t>(bytes) == fingerprint;
}

constexpr std::string_view kSuffix = "_CHANNELS";

}  // namespace

std::optional<SensorNodeSample> decode_accel(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  if (!is_accel(bytes, size)) return std::nullopt;
  const auto time_us = big_endian<std::int64_t>(bytes + kTimeAt);
  if (time_us > kLatestTime_us || time_us < -kLatestTime_us) return std::nullopt;
  SensorNodeSample sample{estimator::from_microseconds(time_us),
                          big_endian<std::int64_t>(bytes + kSequenceAt),
                          big_endian<std::int32_t>(bytes + kNodeAt),
                          {}};
  for (std::size_t i = 0; i < 3; ++i)
    sample.accel_abs_mps2[i] =
        std::bit_cast<double>(big_endian<std::uint64_t>(bytes + kAccelAt + 8 * i));
  return sample;
}

std::optional<std::int64_t> accel_time_us(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  if (!is_accel(bytes, size)) return std::nullopt;
  return big_endian<std::int64_t>(bytes + kTimeAt);
}

std::vector<std::uint8_t> encode_accel(const SensorNodeSample& sample) {
  accel_t message{};
  message.time_us = to_microseconds(sample.time);
  message.sequence = sample.sequence;
  message.node = sample.node;
  for (std::size_t i = 0; i < 3; ++i) message.accel_abs_mps2[i] = sample.accel_abs_mps2[i];
  return encoded(message);
}

std::optional<ChannelTable> decode_channel_table(const void* data, std::size_t size) {
  const auto message = decoded<channel_table_t>({static_cast<const std::uint8_t*>(data), size});
  if (!message || message->channels > kMaxTableChannels) return std::nullopt;
  ChannelTable table;
  table.rate_hz = message->rate_hz;
  for (std::size_t i = 0; i < message->name.size(); ++i)
    table.entries.push_back({message->name[i], message->node[i], message->axis[i]});
  return table;
}

std::string stream_of_table(const std::string& channel) {
  if (!std::string_view(channel).ends_with(kSuffix)) return {};
  return channel.substr(0, channel.size() - kSuffix.size());
}

AccelMessages::AccelMessages(std::vector<std::string> names, std::vector<AxisAddress> addresses,
                             double rate_hz)
    : names_(std::move(names)), addresses_(std::move(addresses)), rate_hz_(rate_hz) {
  assert(names_.size() == addresses_.size());
  std::map<std::pair<std::string, std::int32_t>, std::size_t> places;
  for (std::size_t i = 0; i < addresses_.size(); ++i) {
    const AxisAddress& a = addresses_[i];
    const auto [at, fresh] = places.try_emplace({a.lcm_channel, a.node}, nodes_.size());
    if (fresh) nodes_.push_back(Node{a.lcm_channel, a.node, {}, 0});
    nodes_[at->second].channels.push_back(i);
  }
}

std::vector<Message> AccelMessages::samples(std::int64_t time_us,
                                            const std::vector<double>& values) {
  std::vector<Message> out;
  for (Node& node : nodes_) {
    SensorNodeSample sample{estimator::from_microseconds(time_us), node.sequence++, node.node, {}};
    sample.accel_abs_mps2.fill(std::numeric_limits<double>::quiet_NaN());
    bool any = false;
    for (const std::size_t c : node.channels) {
      sample.accel_abs_mps2.at(static_cast<std::size_t>(addresses_[c].axis)) = values[c];
      any = any || std::isfinite(values[c]);
    }
    if (any) out.push_back({node.lcm_channel, encode_accel(sample)});
  }
  return out;
}

std::vector<Message> AccelMessages::tables(std::int64_t time_us) const {
  std::vector<std::string> lcm_channels;
  for (const Node& node : nodes_)
    if (std::find(lcm_channels.begin(), lcm_channels.end(), node.lcm_channel) == lcm_channels.end())
      lcm_channels.push_back(node.lcm_channel);
  std::vector<Message> out;
  for (const std::string& lcm_channel : lcm_channels) {
    channel_table_t table{};
    table.time_us = time_us;
    table.rate_hz = rate_hz_;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (addresses_[i].lcm_channel != lcm_channel) continue;
      table.name.push_back(names_[i]);
      table.node.push_back(addresses_[i].node);
      table.axis.push_back(addresses_[i].axis);
    }
    table.channels = static_cast<std::int32_t>(table.name.size());
    out.push_back({lcm_channel + "_CHANNELS", encoded(table)});
  }
  return out;
}

}  // namespace framewatch::drivers
