// SPDX-License-Identifier: MIT
#include "daemon/monitor/live/intake_monitor.h"

#include <algorithm>
#include <fstream>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/log.h"
#include "drivers/can/bus_load.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

/// Appends the increase since `seen`, if any, and sets `seen`.
void add(std::string& news, std::int64_t& seen, std::int64_t now, const char* what,
         const std::string& of = "") {
  if (now > seen)
    news += fmt::format("{}{} {}{}", news.empty() ? "" : ", ", now - seen, what,
                        of.empty() ? "" : " (" + of + ")");
  seen = now;
}

}  // namespace

CanMonitor::CanMonitor(const Config& config, std::string statistics)
    : config_(config),
      statistics_(std::move(statistics)),
      before_(config.can.buses.size()),
      extended_(config.can.buses.size()),
      fd_(config.can.buses.size()) {
  for (std::size_t b = 0; b < config.can.buses.size(); ++b) {
    expected_load_.push_back(drivers::bus_load(config.can, static_cast<int>(b)).share);
    fd_[b] = config.can.buses[b].fd;
  }
  for (const drivers::CanNodeMap& node : config.can.nodes)
    for (const drivers::CanMessageMap& message : node.messages)
      if (message.extended) extended_[static_cast<std::size_t>(node.bus)] = true;
}

std::optional<CanMonitor::Counted> CanMonitor::counted(const std::string& interface) const {
  Counted sum;
  for (const char* direction : {"rx", "tx"}) {
    const std::string at = statistics_ + "/" + interface + "/statistics/" + direction;
    std::int64_t frames = 0, bytes = 0;
    if (!(std::ifstream(at + "_packets") >> frames) || !(std::ifstream(at + "_bytes") >> bytes))
      return std::nullopt;
    sum.frames += frames;
    sum.bytes += bytes;
  }
  return sum;
}

std::optional<can_status_t> CanMonitor::collect(const drivers::CanIntake& can,
                                                const drivers::CanSource& source,
                                                std::int64_t now_us) {
  if (config_.can.empty() || !second_.due(now_us)) return std::nullopt;
  const bool stepped_back = now_us < last_us_;
  if (stepped_back) std::fill(before_.begin(), before_.end(), std::nullopt);
  can_status_t status{};
  status.time_us = now_us;
  status.dropped = source.dropped();
  status.buses = static_cast<std::int32_t>(config_.can.buses.size());
  const double seconds = 1e-6 * static_cast<double>(now_us - last_us_);
  for (std::size_t b = 0; b < config_.can.buses.size(); ++b)
    add_bus(b, can, source, seconds, status);
  last_us_ = now_us;
  return status;
}

void CanMonitor::add_bus(std::size_t b, const drivers::CanIntake& can,
                         const drivers::CanSource& source, double seconds, can_status_t& status) {
  const drivers::CanBusMap& bus = config_.can.buses[b];
  const drivers::CanBusCounters& counters = can.buses()[b];
  const bool open = source.state(static_cast<int>(b)).open;
  double frames_hz = estimator::kNaN, load = estimator::kNaN;
  const std::optional<Counted> now = counted(bus.interface);
  // The counters restart at zero when an interface is set up again.
  if (now && before_[b] && now->frames >= before_[b]->frames && now->bytes >= before_[b]->bytes) {
    const auto frames = static_cast<double>(now->frames - before_[b]->frames);
    const auto bytes = static_cast<double>(now->bytes - before_[b]->bytes);
    frames_hz = frames / seconds;
    const int mean_bytes = frames > 0 ? static_cast<int>(bytes / frames + 0.5) : 0;
    load = frames_hz * drivers::worst_frame_s(mean_bytes, extended_[b], fd_[b], bus.bit_rate,
                                              bus.data_bit_rate);
  }
  before_[b] = now;
  status.interface.push_back(bus.interface);
  status.state.push_back(open ? static_cast<std::int32_t>(counters.state) : -1);
  status.frames_hz.push_back(frames_hz);
  status.load.push_back(load);
  status.expected_load.push_back(expected_load_[b]);
  status.error_frames.push_back(counters.error_frames);
  status.bus_off.push_back(counters.bus_off);
  status.bus_errors.push_back(counters.bus_errors);
  status.overflow.push_back(counters.overflow);
}

CanWarnings::CanWarnings(const Config& config)
    : config_(config), buses_(config.can.buses.size()), nodes_(config.can.nodes.size()) {}

std::string CanWarnings::bus_news(std::size_t b, const drivers::CanBusCounters& now, bool open) {
  Bus& bus = buses_[b];
  std::string news;
  if (open != bus.open) news = open ? "is up" : "is down or gone";
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
  drivers::CanNodeCounters& before = node.counters;
  std::string news;
  add(news, before.lost, now.lost, "lost");
  add(news, before.late, now.late, "late");
  add(news, before.duplicates, now.duplicates, "twice");
  add(news, before.unplaced, now.unplaced, "without a timestamp");
  add(news, before.wrong_length, now.wrong_length, "of a wrong length");
  add(news, before.wrong_kind, now.wrong_kind, "classical instead of CAN FD or the reverse");
  add(news, before.not_finite, now.not_finite, "values that are not numbers");
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

std::vector<std::string> CanWarnings::collect(const drivers::CanIntake& can,
                                              const drivers::CanSource& source,
                                              std::int64_t now_us) {
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
  add(host, steps_, source.clock_steps() + can.host_steps(), "steps of the host's clock corrected");
  if (!host.empty()) out.push_back(host);
  return out;
}

void IntakeWarnings::update(const LiveEstimation& live, std::int64_t now_us) {
  if (!second_.due(now_us)) return;
  const Estimation& estimation = live.estimation();
  const drivers::ReceiverCounters dropped = live.dropped();
  const estimator::PipelineCounters pipeline = estimation.pipeline().counters();
  const drivers::IntakeCounters& intake = estimation.intake().counters();
  const std::vector<estimator::AxisCounters> axes = estimation.axis_counters();
  std::int64_t late = 0, rejected = 0;
  std::string rejected_of;
  rejected_.resize(axes.size());
  for (std::size_t a = 0; a < axes.size(); ++a) {
    late += axes[a].late;
    rejected += axes[a].rejected;
    if (axes[a].rejected > std::exchange(rejected_[a], axes[a].rejected))
      rejected_of += (rejected_of.empty() ? "" : " ") + estimation.pipeline().axes()[a].name;
  }
  std::string news;
  add(news, seen_[0], intake.malformed, "undecodable messages");
  add(news, seen_[1], intake.duplicate, "duplicate messages");
  add(news, seen_[2], estimation.intake().lost(), "messages lost");
  add(news, seen_[3], live.state().queue_dropped, "messages dropped by a full queue");
  add(news, seen_[4], late, "samples late");
  add(news, seen_[5], rejected, "samples rejected", rejected_of);
  add(news, seen_[6], estimation.intake().backwards(), "steps back in time");
  add(news, seen_[7], intake.other_sender, "messages of a second sender");
  add(news, seen_[8], pipeline.interruptions, "interruptions that restarted the window");
  add(news, seen_[9], dropped.from_elsewhere, "datagrams from elsewhere dropped");
  add(news, seen_[10], dropped.malformed, "datagrams that are not LCM");
  add(news, seen_[11], dropped.unfinished, "messages dropped because a part never came");
  add(news, seen_[12], dropped.overflowed, "datagrams dropped by the kernel's full buffer");
  if (!news.empty()) log(LogLevel::warning, news);
  for (const std::string& name : estimation.intake().binding().unbound())
    if (!said_unbound_) log(LogLevel::warning, fmt::format("no message carries {} yet", name));
  said_unbound_ = true;
}

}  // namespace framewatch::daemon
