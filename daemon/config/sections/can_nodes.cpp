#include "daemon/config/sections/can_reader.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

namespace framewatch::daemon {

using drivers::CanNodeMap;
using drivers::CanTiming;

void CanConfigReader::read_node(const TomlValue& table) {
  const TomlEntry* entry = table.kind == TomlKind::table ? table.find("name") : nullptr;
  const std::string label =
      entry != nullptr ? fmt::format("can_node '{}'", entry->value.text) : "can_node";
  CanNodeReading node;
  ConfigSection& section = node.section.emplace("can_node", label, &table, TextPlace{}, problems_);
  section.read_into<CanNodeSettings>(node);
  section.read_into(node.map);
  for (const CanNodeReading& other : nodes_)
    if (section.given("name") && other.map.name == node.map.name)
      section.problem("name", fmt::format("{} is the name of another node", node.map.name));
  const std::string interface = section.text("can");
  const auto bus = interface.empty() && buses_.size() == 1 ? 0 : find_bus(interface);
  if (!bus) {
    section.problem("can", buses_.empty()      ? "there is no [[can]]"
                           : interface.empty() ? "is missing: there are several buses"
                                               : unknown_bus(interface));
    return;
  }
  node.bus = *bus;
  node.map.bus = static_cast<int>(*bus);
  for (const std::string& name : node.messages)
    if (buses_[node.bus].known && find_can_message(buses_[node.bus], name) == nullptr)
      section.problem("messages", unknown_can_message(buses_[node.bus], name));
  if (!node.j1939 && section.given("source_address") && node.source_address >= 0)
    section.problem("source_address", "is J1939's: j1939 = true is missing");
  read_times(node, section);
  nodes_.push_back(std::move(node));
}

void CanConfigReader::read_times(CanNodeReading& node, ConfigSection& section) {
  CanNodeMap& map = node.map;
  const double rate_hz = section.number("rate_hz");
  map.period_us = 1e6 / (rate_hz > 0 ? rate_hz : config_.pipeline.options.rate_hz);
  const std::string timing = section.text("timing");
  const bool has_clock = section.given("clock"), has_counter = section.given("counter");
  map.timing = timing == "sync"                                         ? CanTiming::sync
               : timing == "clock" || (timing.empty() && has_clock)     ? CanTiming::clock
               : timing == "counter" || (timing.empty() && has_counter) ? CanTiming::counter
                                                                        : CanTiming::period;
  read_stamp("clock", map.timing == CanTiming::clock, false, node.clock, node, section);
  read_stamp("counter", map.timing == CanTiming::counter, map.timing == CanTiming::sync,
             node.counter, node, section);
  if (map.timing == CanTiming::sync && section.given("rate_hz") && rate_hz > 0)
    section.problem("rate_hz", "the SYNC sets the rate: see sync_period_s of [[can]]");
  if (map.timing == CanTiming::sync) map.period_us = config_.can.buses[node.bus].sync_period_us;
  if (map.timing == CanTiming::sync && map.samples_per_frame > 1)
    section.problem("samples_per_frame", "must be 1 with timing = \"sync\"");
  if (map.timing == CanTiming::sync && section.given("latency_s"))
    section.problem("latency_s", "with timing = \"sync\" it is delay_s that counts");
  if (map.timing != CanTiming::sync && section.given("delay_s"))
    section.problem("delay_s", "without timing = \"sync\" it is latency_s that counts");
}

void CanConfigReader::read_stamp(const char* key, bool needed, bool allowed, CanSignal& found,
                                 const CanNodeReading& node, ConfigSection& section) {
  if (!section.given(key) || section.text(key).empty()) {
    if (needed) section.problem(key, fmt::format("is missing for timing = \"{}\"", key));
    return;
  }
  if (!needed && !allowed) return section.problem(key, "is not used with this timing");
  if (!buses_[node.bus].known) return;
  found = find_can_signal(buses_[node.bus], section.text(key));
  if (found.problem.empty() && std::find(node.messages.begin(), node.messages.end(),
                                         found.message->name) == node.messages.end())
    found.problem = fmt::format("{} is not one of the node's messages", found.message->name);
  if (found.problem.empty() && found.signal->multiplexed_by)
    found.problem = "must not be multiplexed";
  if (!found.problem.empty()) section.problem(key, found.problem);
}

}  // namespace framewatch::daemon
