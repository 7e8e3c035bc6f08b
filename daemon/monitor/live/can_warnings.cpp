#include "daemon/monitor/live/can_warnings.h"

#include <utility>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

void add(std::string& news, std::int64_t before, std::int64_t now, const char* what) {
  if (now > before) news += fmt::format("{}{} {}", news.empty() ? "" : ", ", now - before, what);
}

}  // namespace

CanWarnings::CanWarnings(const Config& config)
    : config_(config), buses_(config.can.buses.size()), nodes_(config.can.nodes.size()) {}

std::string CanWarnings::bus_news(std::size_t b, const drivers::CanBusCounters& now, bool open) {
  Bus& bus = buses_[b];
  std::string news;
  if (open != bus.open) news = open ? "is there" : "is down or gone";
  if (now.state != bus.counters.state)
    news += fmt::format("{}{}", news.empty() ? "" : ", ", drivers::to_string(now.state));
  add(news, bus.counters.bus_off, now.bus_off, "times bus-off");
  add(news, bus.counters.overflow, now.overflow, "overflows of the controller");
  add(news, bus.counters.bus_errors, now.bus_errors, "bus errors");
  bus = {now, open};
  return news;
}

std::string CanWarnings::node_news(std::size_t n, const drivers::CanNodeCounters& now) {
  Node& node = nodes_[n];
  const drivers::CanNodeCounters& before = node.counters;
  std::string news;
  add(news, before.lost, now.lost, "lost");
  add(news, before.late, now.late, "late");
  add(news, before.duplicates, now.duplicates, "twice");
  add(news, before.unplaced, now.unplaced, "without a time");
  add(news, before.wrong_length, now.wrong_length, "of a wrong length");
  add(news, before.wrong_kind, now.wrong_kind, "classical for CAN FD or the reverse");
  add(news, before.not_finite, now.not_finite, "values that are no number");
  add(news, before.restarts, now.restarts, "restarts");
  add(news, before.boot_ups, now.boot_ups, "boot-ups");
  if (now.emergencies > before.emergencies)
    news += fmt::format("{}emergency {:04X}h", news.empty() ? "" : ", ", now.last_emergency);
  const bool silent = now.frames == before.frames;
  if (silent != node.silent)
    news += fmt::format("{}{}", news.empty() ? "" : ", ", silent ? "silent" : "heard");
  node = {now, silent};
  return news;
}

std::vector<std::string> CanWarnings::look(const drivers::CanIntake& can,
                                           const drivers::CanSource& source, std::int64_t now_us) {
  std::vector<std::string> out;
  if (config_.can.empty() || !second_.due(now_us)) return out;
  if (!std::exchange(begun_, true)) return out;
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    const std::string& name = config_.can.buses[b].interface;
    const std::string news = bus_news(b, can.buses()[b], source.state(static_cast<int>(b)).open);
    std::string line = news.empty() ? "" : fmt::format("{}: {}", name, news);
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      if (config_.can.nodes[n].bus != static_cast<int>(b)) continue;
      const std::string of_node = node_news(n, can.node(n));
      if (of_node.empty()) continue;
      line += line.empty() ? name + ": " : "; ";
      line += fmt::format("{}: {}", config_.can.nodes[n].name, of_node);
    }
    if (!line.empty()) out.push_back(line);
  }
  std::string host;
  add(host, dropped_, source.dropped(), "CAN frames dropped by full receive queues");
  add(host, steps_, source.clock_steps() + can.host_steps(), "steps of the host's clock taken out");
  dropped_ = source.dropped();
  steps_ = source.clock_steps() + can.host_steps();
  if (!host.empty()) out.push_back(host);
  return out;
}

}  // namespace framewatch::daemon
