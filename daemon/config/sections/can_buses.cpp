// SPDX-License-Identifier: MIT
#include "daemon/config/sections/can_buses.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/config/keys/suggest.h"
#include "drivers/files/file_problems.h"
#include "drivers/files/standard_streams.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kLongestInterface = 15;

void read_dbc(const std::string& name, const Config& config, CanBusReading& bus,
              std::vector<TextProblem>& problems) {
  const std::filesystem::path beside = drivers::folder_of_paths_in(config.path);
  const std::string path = (beside / name).string();
  std::string error;
  const std::optional<std::string> text = read_text_file(path, error);
  std::vector<drivers::Problem> found;
  std::optional<drivers::Dbc> dbc;
  if (text)
    dbc = drivers::parse_dbc(path, *text, found);
  else
    bus.section.problem("dbc", fmt::format("{}: {}", path, error));
  for (const drivers::Problem& p : found) problems.push_back({{}, p.message, p.where});
  bus.known = bus.known && dbc;
  if (!dbc) return;
  const std::size_t others = bus.messages.size();
  for (drivers::DbcMessage& message : dbc->messages) {
    for (std::size_t i = 0; i < others; ++i)
      if (CanMessage& other = bus.messages[i]; other.name == message.name)
        other.contradictions.push_back(
            {other.line, fmt::format("{} is also a message of {}", message.name, path)});
    bus.messages.push_back({std::move(message), path});
  }
}

}  // namespace

std::vector<CanBusReading> read_can_buses(const TomlValue& document, Config& config,
                                          std::vector<TextProblem>& problems) {
  std::vector<CanBusReading> out;
  for (const TomlValue* table : tables_of(document, "can", problems)) {
    out.push_back({ConfigSection("can", "can", table, {}, problems), {}, true});
    CanBusReading& bus = out.back();
    ConfigSection& section = bus.section;
    auto map = section.read<drivers::CanBusMap>();
    const double sync_s = section.number("sync_period_s");
    map.sync_period_us = sync_s > 0 ? 1e6 * sync_s : 1e6 / config.pipeline.options.rate_hz;
    if (section.good("sync_overflow") && map.sync_overflow == 1)
      section.problem("sync_overflow", "must be 0 or 2 to 240, got 1");
    if (section.given("interface") &&
        (map.interface.empty() || map.interface.size() > kLongestInterface))
      section.problem("interface",
                      fmt::format("an interface's name has 1 to {} characters", kLongestInterface));
    for (const drivers::CanBusMap& other : config.can.buses)
      if (section.given("interface") && other.interface == map.interface)
        section.problem("interface", fmt::format("{} has a [[can]] already", map.interface));
    if (section.good("dbc"))
      for (const std::string& name : section.texts("dbc")) read_dbc(name, config, bus, problems);
    else
      bus.known = false;
    config.can.buses.push_back(map);
  }
  return out;
}

const CanMessage* find_can_message(const CanBusReading& bus, const std::string& name) {
  const auto at = std::find_if(bus.messages.begin(), bus.messages.end(),
                               [&](const CanMessage& m) { return m.name == name; });
  return at == bus.messages.end() ? nullptr : &*at;
}

std::string unknown_can_message(const CanBusReading& bus, const std::string& name) {
  std::vector<std::string> names;
  for (const CanMessage& m : bus.messages) names.push_back(m.name);
  return fmt::format("no DBC file of the bus has the message {}{}", name,
                     did_you_mean(name, names));
}

CanSignal find_can_signal(const CanBusReading& bus, const std::string& text) {
  CanSignal found;
  const std::size_t dot = text.find('.');
  if (dot == std::string::npos) {
    found.problem = fmt::format("expected Message.Signal, got \"{}\"", text);
    return found;
  }
  const std::string message = text.substr(0, dot), signal = text.substr(dot + 1);
  found.message = find_can_message(bus, message);
  if (found.message == nullptr) {
    found.problem = unknown_can_message(bus, message);
    return found;
  }
  found.signal = found.message->find(signal);
  if (found.signal == nullptr) {
    std::vector<std::string> names;
    for (const drivers::DbcSignal& s : found.message->signals) names.push_back(s.name);
    found.problem =
        fmt::format("message {} has no signal {}{}", message, signal, did_you_mean(signal, names));
  }
  return found;
}

}  // namespace framewatch::daemon
