// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "daemon/config/keys/can_options.h"
#include "daemon/config/keys/section.h"
#include "daemon/config/keys/suggest.h"
#include "daemon/config/sections/can_buses.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/config/sections/sections.h"
#include "daemon/config/sections/settings.h"
#include "drivers/dbc/dbc.h"
#include "drivers/files/file_problems.h"
#include "drivers/records/unit_text.h"
#include "estimator/motion/acquisition.h"

namespace framewatch::daemon {
namespace {

using drivers::CanMessageMap;
using drivers::CanNodeMap;
using drivers::CanSwitch;
using drivers::CanTiming;
using drivers::DbcMessage;
using drivers::DbcSignal;

/// Returns the map of a whole message, without readings and multiplexors.
CanMessageMap map_of(const DbcMessage& m) {
  CanMessageMap map;
  map.name = m.name;
  map.id = m.id;
  map.mask = m.extended ? 0x1FFFFFFFu : 0x7FFu;
  map.extended = m.extended;
  map.length = m.length;
  map.fd = m.length > 8;
  return map;
}

std::string fd_is_missing(const CanMessageMap& m, const std::string& interface) {
  return fmt::format("{} has {} bytes: fd = true is missing for {}", m.name, m.length, interface);
}

/// A sensor node while it is read: its table, if any, and its channels.
struct CanNodeReading : CanNodeSettings {
  drivers::CanNodeMap map;
  std::optional<ConfigSection> section;
  std::size_t bus = 0;
  CanSignal counter, clock;
};

/// Reads the CAN part of a configuration: buses, sensor nodes and the signals of channels.
class CanConfigReader {
 public:
  CanConfigReader(const TomlValue& document, Config& config, std::vector<TextProblem>& problems)
      : document_(document), config_(config), problems_(problems) {}

  void run() {
    buses_ = read_can_buses(document_, config_, problems_);
    for (const TomlValue* table : tables_of(document_, "can_node", problems_)) read_node(*table);
    for (std::size_t i = 0; i < config_.sources.size(); ++i)
      if (!config_.sources[i].can.empty()) read_source(i);
    for (CanNodeReading& node : nodes_) finish_node(node);
    for (std::size_t i = 0; i < config_.weather.size(); ++i)
      if (!config_.weather[i].can.empty() && !config_.weather[i].dbc_signal.empty())
        read_weather_signal(i);
    check_used_messages();
    check_ids();
    config_.doubts = with_file(config_.path, std::move(doubts_));
    drivers::CanMap& can = config_.can;
    can.grid_period_us = 1e6 / config_.pipeline.options.rate_hz;
    std::set<int> sync_buses;
    for (const CanNodeMap& node : can.nodes) {
      can.resample = can.resample || node.timing != CanTiming::sync;
      if (node.timing == CanTiming::sync) sync_buses.insert(node.bus);
    }
    can.resample = can.resample || sync_buses.size() > 1;
  }

 private:
  std::optional<std::size_t> find_bus(const std::string& interface) const {
    for (std::size_t b = 0; b < config_.can.buses.size(); ++b)
      if (config_.can.buses[b].interface == interface) return b;
    return std::nullopt;
  }

  std::string unknown_bus(const std::string& interface) const {
    std::vector<std::string> names;
    for (const drivers::CanBusMap& bus : config_.can.buses) names.push_back(bus.interface);
    return fmt::format("no [[can]] has interface = \"{}\"{}", interface,
                       did_you_mean(interface, names));
  }

  void read_node(const TomlValue& table) {
    const TomlEntry* entry = table.kind == TomlKind::table ? table.find("name") : nullptr;
    const std::string label =
        entry != nullptr ? fmt::format("can_node '{}'", entry->value.text) : "can_node";
    CanNodeReading node;
    ConfigSection& section =
        node.section.emplace("can_node", label, &table, TextPlace{}, problems_);
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

  void read_times(CanNodeReading& node, ConfigSection& section) {
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
      section.problem("latency_s", "does not apply with timing = \"sync\": use delay_s");
    if (map.timing != CanTiming::sync && section.given("delay_s"))
      section.problem("delay_s", "applies only with timing = \"sync\": use latency_s");
  }

  void read_stamp(const char* key, bool needed, bool allowed, CanSignal& found,
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
    if (found.problem.empty() && !found.signal->multiplexor.empty())
      found.problem = "must not be multiplexed";
    if (!found.problem.empty()) section.problem(key, found.problem);
  }

  /// Returns the value of a key of a channel, or null.
  const TomlEntry* entry_of(std::size_t channel, std::string_view key) const {
    const std::string& wanted = config_.pipeline.axes[channel].name;
    for (const TomlValue& table : document_.find("channel")->value.items)
      if (const TomlEntry* name = table.find("name"); name != nullptr && name->value.text == wanted)
        return table.find(key);
    return nullptr;
  }

  TextPlace place_of_source(std::size_t channel) const {
    const TomlEntry* source = entry_of(channel, "source");
    return source == nullptr ? document_.find("channel")->place : source->place;
  }

  void source_problem(std::size_t channel, const std::string& message) {
    problems_.push_back(
        {place_of_source(channel),
         fmt::format("channel '{}'.source: {}", config_.pipeline.axes[channel].name, message)});
  }

  CanNodeReading* node_of(std::size_t channel, std::size_t bus, const std::string& message) {
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
      source_problem(channel,
                     fmt::format("can_node: is missing: {} and {} have the message {}",
                                 candidates[0]->map.name, candidates[1]->map.name, message));
      return nullptr;
    }
    if (candidates[0]->bus != bus) {
      source_problem(channel, fmt::format("can: {} is not the bus of {}",
                                          config_.sources[channel].can, wanted));
      return nullptr;
    }
    return candidates[0];
  }

  void read_source(std::size_t channel) {
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
                                         ? "dbc_signal: write # in place of the sample's number"
                                         : "dbc_signal: # is for samples_per_frame > 1");
    const auto nth = [&](int number) {
      std::string text = source.dbc_signal;
      if (hash != std::string::npos) text.replace(hash, 1, std::to_string(number));
      return text;
    };
    const int first =
        find_can_signal(buses_[*bus], nth(0)).signal == nullptr && samples > 1 ? 1 : 0;
    for (int s = 0; s < samples; ++s) {
      const CanSignal found = find_can_signal(buses_[*bus], nth(first + s));
      if (!found.problem.empty()) return source_problem(channel, "dbc_signal: " + found.problem);
      add_reading(channel, *node, found, s);
      if (s == 0) doubt_unit(channel, found);
    }
  }

  /// Reads the signal of a covariate.
  void read_weather_signal(std::size_t covariate) {
    const WeatherSettings& w = config_.weather[covariate];
    const TomlValue& table = document_.find("weather")->value.items[covariate];
    const TextPlace place = table.find("source")->place;
    const auto problem = [&](const std::string& message) {
      problems_.push_back({place, fmt::format("weather '{}'.source: {}", w.name, message)});
    };
    const auto bus = find_bus(w.can);
    if (!bus) return problem("can: " + unknown_bus(w.can));
    if (!buses_[*bus].known) return;
    const CanSignal found = find_can_signal(buses_[*bus], w.dbc_signal);
    if (!found.problem.empty()) return problem("dbc_signal: " + found.problem);
    const DbcMessage& m = *found.message;
    CanMessageMap map = map_of(m);
    map.switches = switches_of(m, *found.signal);
    if (map.fd && !config_.can.buses[*bus].fd)
      return problem("dbc_signal: " + fd_is_missing(map, w.can));
    weather_messages_.insert(found.message);
    config_.can.values.push_back(
        {static_cast<int>(*bus), std::move(map), found.signal->field, covariate});
    const bool kelvin = found.signal->unit == "K" || found.signal->unit == "kelvin";
    if (kelvin && table.find("offset") == nullptr && w.name.ends_with("_degc"))
      doubts_.push_back(
          {place,
           fmt::format("weather '{}': {}:{} says that {} is in kelvin: set offset = 273.15", w.name,
                       found.message->path, found.signal->line, found.signal->name)});
  }

  /// Warns of a signal with a unit that the channel does not convert, because it has no scale.
  void doubt_unit(std::size_t channel, const CanSignal& found) {
    const std::string& unit = found.signal->unit;
    if (unit.empty() || entry_of(channel, "scale") != nullptr) return;
    const estimator::SensorAxis& axis = config_.pipeline.axes[channel];
    const std::optional<double> factor =
        axis.is_force ? drivers::newtons_per(unit) : drivers::mps2_per(unit);
    if (factor && std::abs(*factor - 1) < 1e-9) return;
    doubts_.push_back(
        {place_of_source(channel),
         fmt::format("channel '{}': {}:{} says that {} is in {}, {}, and the channel has no scale, "
                     "so its values count as {}: {}",
                     axis.name, found.message->path, found.signal->line, found.signal->name,
                     drivers::show_text(unit),
                     factor
                         ? fmt::format("which is {:g} {}", *factor, axis.is_force ? "N" : "m/s^2")
                     : axis.is_force ? "which is not a unit of force"
                                     : "which is not a unit of acceleration",
                     axis.is_force ? "N" : "m/s^2",
                     factor ? fmt::format("set scale = {:g}", *factor)
                            : "use another signal, or set scale if the file is wrong")});
  }

  void add_reading(std::size_t channel, CanNodeReading& node, const CanSignal& found, int sample) {
    const DbcMessage& m = *found.message;
    for (const CanMessageMap& map : node.map.messages)
      for (const drivers::CanReading& r : map.readings)
        if (map.name == m.name && r.name == found.signal->name)
          return source_problem(
              channel,
              fmt::format("dbc_signal: {}.{} is the source of channel '{}' already", m.name, r.name,
                          config_.pipeline.axes[static_cast<std::size_t>(r.axis)].name));
    CanMessageMap& map = message_map(node, m, switches_of(m, *found.signal));
    const estimator::SensorAxis& axis = config_.pipeline.axes[channel];
    const estimator::SampleBound bound = estimator::sample_bound(axis);
    const auto [least, most] = std::minmax({bound.least / axis.scale, bound.most / axis.scale});
    map.readings.push_back(
        {found.signal->field, static_cast<int>(channel), sample, found.signal->name, least, most});
  }

  /// Returns the map of the part of a message that these multiplexors switch. Creates it if it is
  /// missing.
  CanMessageMap& message_map(CanNodeReading& node, const DbcMessage& m,
                             std::vector<CanSwitch> switches) {
    const auto same = [](const CanSwitch& a, const CanSwitch& b) {
      return a.field.start == b.field.start && a.values == b.values;
    };
    for (CanMessageMap& map : node.map.messages)
      if (map.name == m.name && std::equal(map.switches.begin(), map.switches.end(),
                                           switches.begin(), switches.end(), same))
        return map;
    CanMessageMap map = map_of(m);
    map.id += node.id_offset;
    if (node.j1939) {
      const bool broadcast = ((m.id >> 16) & 0xFFu) >= 240;
      map.mask = broadcast ? 0x03FFFF00u : 0x03FF0000u;
      if (node.source_address >= 0) {
        map.id = (map.id & ~0xFFu) | static_cast<std::uint32_t>(node.source_address);
        map.mask |= 0xFFu;
      }
    }
    map.switches = std::move(switches);
    node.map.messages.push_back(std::move(map));
    return node.map.messages.back();
  }

  void node_problem(CanNodeReading& node, const std::string& key, const std::string& message) {
    if (node.section)
      node.section->problem(key, message);
    else
      problems_.push_back({{}, fmt::format("can: message {}: {}", node.map.name, message)});
  }

  /// Moves the frame with the time stamp to the front. Leaves out nodes without channels.
  void finish_node(CanNodeReading& node) {
    if (node.map.messages.empty()) return;
    const CanSignal& stamp = node.map.timing == CanTiming::clock ? node.clock : node.counter;
    std::string opens = stamp.message != nullptr ? stamp.message->name : "";
    if (stamp.signal != nullptr) {
      const bool carried = std::any_of(node.map.messages.begin(), node.map.messages.end(),
                                       [&](const CanMessageMap& m) { return m.name == opens; });
      if (!carried) message_map(node, *stamp.message, {});
      for (CanMessageMap& m : node.map.messages)
        if (m.name == opens)
          (node.map.timing == CanTiming::clock ? m.clock : m.counter) = stamp.signal->field;
    }
    const auto rank = [&](const CanMessageMap& m) {
      if (m.name == opens) return std::ptrdiff_t{-1};
      return std::find(node.messages.begin(), node.messages.end(), m.name) - node.messages.begin();
    };
    std::stable_sort(
        node.map.messages.begin(), node.map.messages.end(),
        [&](const CanMessageMap& a, const CanMessageMap& b) { return rank(a) < rank(b); });
    const drivers::CanBusMap& bus = config_.can.buses[node.bus];
    for (const CanMessageMap& m : node.map.messages) {
      if (m.fd && !bus.fd) node_problem(node, "messages", fd_is_missing(m, bus.interface));
      if (m.id > (m.extended ? 0x1FFFFFFFu : 0x7FFu))
        node_problem(node, "id_offset", fmt::format("id {:X} of {} is too large", m.id, m.name));
      if (node.j1939 && !m.extended)
        node_problem(node, "j1939", fmt::format("{} has an 11-bit id", m.name));
      if (node.map.timing == CanTiming::sync && !m.extended && m.id == bus.sync_id)
        node_problem(node, "messages", fmt::format("{} has the id of the SYNC", m.name));
    }
    config_.can.nodes.push_back(node.map);
  }

  /// Reports the rules that messages with a channel, counter or clock break, at their place in the
  /// DBC file. The other messages may break them, because their frames are not decoded.
  void check_used_messages() {
    std::set<const CanMessage*> used = weather_messages_;
    for (const CanNodeReading& node : nodes_)
      for (const CanMessageMap& map : node.map.messages)
        used.insert(find_can_message(buses_[node.bus], map.name));
    for (const CanBusReading& bus : buses_)
      for (const CanMessage& message : bus.messages) {
        if (!used.contains(&message)) continue;
        std::vector<drivers::Problem> found;
        drivers::FileProblems file(message.path, found);
        for (const drivers::DbcRule& rule : broken_rules(message))
          file.add(rule.line, rule.message);
        for (const drivers::Problem& p : found) problems_.push_back({{}, p.message, p.where});
      }
  }

  void check_ids() {
    const auto& nodes = config_.can.nodes;
    for (std::size_t b = 1; b < nodes.size(); ++b)
      for (std::size_t a = 0; a < b; ++a)
        if (nodes[a].bus == nodes[b].bus) check_pair(nodes[a], nodes[b]);
  }

  void check_pair(const CanNodeMap& a, const CanNodeMap& b) {
    for (const CanMessageMap& m : a.messages)
      for (const CanMessageMap& n : b.messages) {
        if (m.extended != n.extended || ((m.id ^ n.id) & m.mask & n.mask) != 0) continue;
        const auto of = std::find_if(nodes_.begin(), nodes_.end(), [&](const CanNodeReading& node) {
          return node.map.name == b.name;
        });
        return node_problem(
            *of, "messages",
            fmt::format("{} has the same id as {} of node {}: {:X}", n.name, m.name, a.name, n.id));
      }
  }

  const TomlValue& document_;
  Config& config_;
  std::vector<TextProblem>& problems_;
  std::vector<TextProblem> doubts_;
  std::vector<CanBusReading> buses_;
  std::vector<CanNodeReading> nodes_;
  std::set<const CanMessage*> weather_messages_;
};

}  // namespace

void read_can(const TomlValue& document, Config& config, std::vector<TextProblem>& problems) {
  CanConfigReader(document, config, problems).run();
}

}  // namespace framewatch::daemon
