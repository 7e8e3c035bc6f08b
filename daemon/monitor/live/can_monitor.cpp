#include "daemon/monitor/live/can_monitor.h"

#include <algorithm>
#include <fstream>

#include "drivers/can/bus_load.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
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

std::optional<can_status_t> CanMonitor::look(const drivers::CanIntake& can,
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

}  // namespace framewatch::daemon
