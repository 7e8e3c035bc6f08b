// SPDX-License-Identifier: MIT
#include "daemon/monitor/live/housekeeping.h"

#include <utility>

#include <fmt/core.h>
#include <lcm/lcm-cpp.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kSilent_s = 2;

/// Returns the line that `systemctl status` shows.
std::string status_line(const LiveEstimation& live, const Config& config, std::int64_t now_us) {
  const LiveTimes& times = live.times();
  const std::size_t raised = live.estimation().raised().all().size();
  const std::string events = raised > 0 ? fmt::format("{} events raised; ", raised) : "";
  if (times.received_us == 0) return events + "waiting for the first sample";
  const std::int64_t silent_s = (now_us - times.received_us) / 1'000'000;
  if (silent_s > kSilent_s) return fmt::format("{}no samples for {} s", events, silent_s);
  return fmt::format("{}estimating {} from {} channels, {} windows so far", events,
                     config.pipeline.structure.name, config.pipeline.axes.size(),
                     live.estimation().windows());
}

}  // namespace

Housekeeping::Housekeeping(const Config& config, const std::string& text,
                           const std::string& state_path, int state_every_s,
                           const StartCount& starts, bool resumed)
    : state_(state_path, state_every_s),
      can_warnings_(config),
      can_monitor_(config),
      baseline_(config),
      gap_(config),
      reloader_(config, text),
      report_(starts, resumed),
      config_(config) {}

void Housekeeping::update(LiveEstimation& live, lcm::LCM& lcm, ServiceManager& manager,
                          const std::vector<RaisedEvents*>& raised) {
  const std::int64_t now_us = host_clock_us();
  Estimation& estimation = live.estimation();
  intake_warnings_.update(live, now_us);
  for (const std::string& news : can_warnings_.collect(estimation.can(), live.can(), now_us))
    log(LogLevel::warning, news);
  if (const auto buses = can_monitor_.collect(estimation.can(), live.can(), now_us))
    lcm.publish(config_.lcm.prefix + "CAN", &*buses);
  state_.update(live.config(), estimation, now_us);
  baseline_.update(estimation);
  gap_.poll(estimation, now_us);
  if (const auto report = report_.collect(live, raised, state_, reloader_.count(), now_us)) {
    lcm.publish(config_.lcm.prefix + "SERVICE", &*report);
    const reception_t reception = reception_report(live, now_us);
    lcm.publish(config_.lcm.prefix + "RECEPTION", &reception);
    manager.status(status_line(live, config_, now_us));
  }
  const std::int64_t steady_us = steady_clock_us();
  if (progress_.well(estimation.pipeline().counters(), steady_us)) manager.alive(steady_us);
}

bool Housekeeping::reload(LiveEstimation& live, ServiceManager& manager) {
  manager.reloading();
  auto next = reloader_.read(live.config());
  if (next) {
    live.reconfigure(std::move(next->config), next->reach);
    baseline_ = BaselineKeeper(live.config());
    gap_.reconfigure(live.config());
    state_.soon();
  }
  manager.ready();
  return next.has_value();
}

}  // namespace framewatch::daemon
