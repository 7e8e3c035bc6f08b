#include "daemon/config/sections/can_reader.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "estimator/motion/acquisition.h"

namespace framewatch::daemon {

using drivers::CanMessageMap;
using drivers::DbcMessage;
using drivers::DbcSignal;

TextPlace CanConfigReader::place_of_source(std::size_t channel) const {
  const TomlEntry* channels = document_.find("channel");
  const TomlEntry* source = channels->value.items[channel].find("source");
  return source == nullptr ? channels->place : source->place;
}

void CanConfigReader::source_problem(std::size_t channel, const std::string& message) {
  problems_.push_back(
      {place_of_source(channel),
       fmt::format("channel '{}'.source: {}", config_.pipeline.axes[channel].name, message)});
}

CanNodeReading* CanConfigReader::node_of(std::size_t channel, std::size_t bus,
                                         const std::string& message) {
  const std::string& wanted = config_.sources[channel].can_node;
  std::vector<CanNodeReading*> candidates;
  for (CanNodeReading& node : nodes_) {
    if (!wanted.empty() ? node.map.name != wanted
                        : node.bus != bus || std::find(node.messages.begin(), node.messages.end(),
                                                       message) == node.messages.end())
      continue;
    candidates.push_back(&node);
  }
  if (wanted.empty() && candidates.empty()) {
    CanNodeReading node;
    node.map.name = message;
    node.bus = bus;
    node.map.bus = static_cast<int>(bus);
    node.map.period_us = 1e6 / config_.pipeline.options.rate_hz;
    node.messages = {message};
    nodes_.push_back(std::move(node));
    return &nodes_.back();
  }
  if (candidates.empty()) {
    std::vector<std::string> names;
    for (const CanNodeReading& node : nodes_) names.push_back(node.map.name);
    source_problem(channel, fmt::format("can_node: no [[can_node]] is named \"{}\"{}", wanted,
                                        did_you_mean(wanted, names)));
    return nullptr;
  }
  if (candidates.size() > 1) {
    source_problem(channel, fmt::format("can_node: is missing: {} and {} have the message {}",
                                        candidates[0]->map.name, candidates[1]->map.name, message));
    return nullptr;
  }
  if (candidates[0]->bus != bus) {
    source_problem(
        channel, fmt::format("can: {} is not the bus of {}", config_.sources[channel].can, wanted));
    return nullptr;
  }
  return candidates[0];
}

void CanConfigReader::read_source(std::size_t channel) {
  const AxisSource& source = config_.sources[channel];
  const auto bus = find_bus(source.can);
  if (!bus) return source_problem(channel, "can: " + unknown_bus(source.can));
  if (!buses_[*bus].known) return;
  const std::string message = source.dbc_signal.substr(0, source.dbc_signal.find('.'));
  CanNodeReading* node = node_of(channel, *bus, message);
  if (node == nullptr) return;
  if (std::find(node->messages.begin(), node->messages.end(), message) == node->messages.end())
    return source_problem(channel, fmt::format("dbc_signal: {} is not one of {}'s messages",
                                               message, node->map.name));
  const int samples = node->map.samples_per_frame;
  const std::size_t hash = source.dbc_signal.find('#');
  if ((samples > 1) != (hash != std::string::npos))
    return source_problem(channel, samples > 1
                                       ? "dbc_signal: # is missing, where the sample's number goes"
                                       : "dbc_signal: # is for samples_per_frame > 1");
  const auto nth = [&](int number) {
    std::string text = source.dbc_signal;
    if (hash != std::string::npos) text.replace(hash, 1, std::to_string(number));
    return text;
  };
  const int first = find_can_signal(buses_[*bus], nth(0)).signal == nullptr && samples > 1 ? 1 : 0;
  for (int s = 0; s < samples; ++s) {
    const CanSignal found = find_can_signal(buses_[*bus], nth(first + s));
    if (!found.problem.empty()) return source_problem(channel, "dbc_signal: " + found.problem);
    add_reading(channel, *node, found, s);
  }
}

void CanConfigReader::add_reading(std::size_t channel, CanNodeReading& node, const CanSignal& found,
                                  int sample) {
  const DbcMessage& m = *found.message;
  const DbcSignal* multiplexor = m.multiplexor();
  for (const CanMessageMap& map : node.map.messages)
    for (const drivers::CanReading& r : map.readings)
      if (map.name == m.name && r.name == found.signal->name)
        return source_problem(
            channel,
            fmt::format("dbc_signal: {}.{} is the source of channel '{}' already", m.name, r.name,
                        config_.pipeline.axes[static_cast<std::size_t>(r.axis)].name));
  CanMessageMap& map = message_map(node, m, multiplexor, found.signal->multiplexed_by);
  const estimator::SensorAxis& axis = config_.pipeline.axes[channel];
  const estimator::SampleBound bound = estimator::sample_bound(axis);
  const auto [least, most] = std::minmax({bound.least / axis.scale, bound.most / axis.scale});
  map.readings.push_back(
      {found.signal->field, static_cast<int>(channel), sample, found.signal->name, least, most});
}

CanMessageMap& CanConfigReader::message_map(CanNodeReading& node, const DbcMessage& m,
                                            const DbcSignal* multiplexor,
                                            const std::optional<std::int64_t>& at) {
  for (CanMessageMap& map : node.map.messages)
    if (map.name == m.name && map.multiplexor.has_value() == at.has_value() &&
        (!at || map.multiplexor_value == *at))
      return map;
  CanMessageMap map;
  map.name = m.name;
  map.extended = m.extended;
  map.id = m.id + node.id_offset;
  map.mask = m.extended ? 0x1FFFFFFFu : 0x7FFu;
  if (node.j1939) {
    const bool broadcast = ((m.id >> 16) & 0xFFu) >= 240;
    map.mask = broadcast ? 0x03FFFF00u : 0x03FF0000u;
    if (node.source_address >= 0) {
      map.id = (map.id & ~0xFFu) | static_cast<std::uint32_t>(node.source_address);
      map.mask |= 0xFFu;
    }
  }
  map.length = m.length;
  map.fd = m.length > 8;
  if (at && multiplexor != nullptr) {
    map.multiplexor = multiplexor->field;
    map.multiplexor_value = *at;
  }
  node.map.messages.push_back(std::move(map));
  return node.map.messages.back();
}

}  // namespace framewatch::daemon
