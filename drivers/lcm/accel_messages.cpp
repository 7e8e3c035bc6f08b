#include "drivers/lcm/accel_messages.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <framewatch/channel_table_t.hpp>

#include "drivers/files/encoded.h"

namespace framewatch::drivers {

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
