#include "daemon/config/sections/can_reader.h"

#include <set>

#include <fmt/core.h>

namespace framewatch::daemon {

using drivers::CanNodeMap;
using drivers::CanTiming;

void CanConfigReader::run() {
  buses_ = read_can_buses(document_, config_, problems_);
  for (const TomlValue* table : tables_of(document_, "can_node", problems_)) read_node(*table);
  for (std::size_t i = 0; i < config_.sources.size(); ++i)
    if (!config_.sources[i].can.empty()) read_source(i);
  for (CanNodeReading& node : nodes_) finish_node(node);
  check_ids();
  drivers::CanMap& can = config_.can;
  can.grid_period_us = 1e6 / config_.pipeline.options.rate_hz;
  std::set<int> sync_buses;
  for (const CanNodeMap& node : can.nodes) {
    can.resample = can.resample || node.timing != CanTiming::sync;
    if (node.timing == CanTiming::sync) sync_buses.insert(node.bus);
  }
  can.resample = can.resample || sync_buses.size() > 1;
}

std::optional<std::size_t> CanConfigReader::find_bus(const std::string& interface) const {
  for (std::size_t b = 0; b < config_.can.buses.size(); ++b)
    if (config_.can.buses[b].interface == interface) return b;
  return std::nullopt;
}

std::string CanConfigReader::unknown_bus(const std::string& interface) const {
  std::vector<std::string> names;
  for (const drivers::CanBusMap& bus : config_.can.buses) names.push_back(bus.interface);
  return fmt::format("no [[can]] has interface = \"{}\"{}", interface,
                     did_you_mean(interface, names));
}

void read_can(const TomlValue& document, Config& config, std::vector<TextProblem>& problems) {
  CanConfigReader(document, config, problems).run();
}

}  // namespace framewatch::daemon
