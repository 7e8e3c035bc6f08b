// SPDX-License-Identifier: MIT
#include "daemon/monitor/live/housekeeping.h"

#include <chrono>
#include <utility>

#include <fmt/core.h>
#include <lcm/lcm-cpp.hpp>

#include <framewatch/reception_t.hpp>

#include "daemon/base/file_digest.h"
#include "daemon/base/log.h"
#include "daemon/base/process.h"
#include "daemon/config/channel_addresses.h"
#include "daemon/config/learned_files.h"
#include "daemon/monitor/estimation/state_file.h"
#include "drivers/files/caught.h"
#include "drivers/files/text_output.h"

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

/// Returns how many messages and datagrams LCM's receiver has dropped.
reception_t reception_report(const LiveEstimation& live, std::int64_t now_us) {
  const drivers::ReceiverCounters counters = live.dropped();
  reception_t m{};
  m.time_us = now_us;
  m.datagrams_elsewhere = counters.from_elsewhere;
  m.datagrams_malformed = counters.malformed;
  m.datagrams_overflowed = counters.overflowed;
  m.messages_unfinished = counters.unfinished;
  m.messages_dropped = counters.queue_full;
  return m;
}

/// Returns the configured baseline.
estimator::Baseline configured_baseline(const Config& config) {
  if (config.watch && config.watch->baseline) return *config.watch->baseline;
  return estimator::Baseline(static_cast<std::size_t>(config.pipeline.parameters().size()));
}

std::string written_or_why(const std::string& path, const SavedState& state) {
  std::string problem;
  const std::string thrown = drivers::caught([&] { problem = write_state(path, state); });
  return thrown.empty() ? problem : thrown;
}

}  // namespace

StateKeeper::StateKeeper(std::string path, int every_s)
    : path_(std::move(path)), every_us_(1'000'000LL * every_s) {}

void StateKeeper::update(const Config& config, Estimation& estimation, std::int64_t now_us) {
  if (path_.empty()) return;
  if (next_us_ == 0) next_us_ = now_us + every_us_;
  if (now_us < next_us_ || !written()) return;
  next_us_ = now_us + every_us_;
  const std::string thrown = drivers::caught([&] {
    writing_ = std::async(std::launch::async,
                          [path = path_, state = saved_state(config, estimation, 0)]() {
                            return written_or_why(path, state);
                          });
  });
  if (!thrown.empty()) report("cannot start a thread: " + thrown);
}

void StateKeeper::keep(const Config& config, Estimation& estimation) {
  if (writing_.valid()) report(writing_.get());
  std::string problem;
  const std::string thrown =
      drivers::caught([&] { problem = write_state(path_, saved_state(config, estimation, 0)); });
  report(thrown.empty() ? problem : thrown);
}

bool StateKeeper::written() {
  if (!writing_.valid()) return true;
  if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  report(writing_.get());
  return true;
}

void StateKeeper::report(std::string problem) {
  if (problem.empty()) written_us_ = host_clock_us();
  if (!problem.empty())
    log(LogLevel::error,
        fmt::format(
            "{}: cannot write the state: {}. Check the disk: a restart resumes from an older state",
            path_, problem));
  problem_ = std::move(problem);
}

Housekeeping::Housekeeping(const Config& config, const std::string& text,
                           const std::string& state_path, int state_every_s,
                           const StartCount& starts, bool resumed)
    : state_(state_path, state_every_s),
      can_warnings_(config),
      can_monitor_(config),
      written_baseline_(configured_baseline(config)),
      gap_(config),
      reloader_(config, text),
      config_(config),
      starts_(starts),
      resumed_(resumed),
      started_us_(host_clock_us()) {}

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
  keep_baseline(live);
  gap_.poll(estimation, now_us);
  if (report_.due(now_us)) {
    const service_t report = service_report(live, raised, now_us);
    lcm.publish(config_.lcm.prefix + "SERVICE", &report);
    const reception_t reception = reception_report(live, now_us);
    lcm.publish(config_.lcm.prefix + "RECEPTION", &reception);
    if (const auto mqtt = live.mqtt(now_us)) lcm.publish(config_.lcm.prefix + "MQTT", &*mqtt);
    manager.status(status_line(live, config_, now_us));
  }
  const std::int64_t steady_us = steady_clock_us();
  if (progress_.well(estimation.pipeline().counters(), steady_us)) manager.alive(steady_us);
}

/// Adds newly learned parameters of the baseline to the configured file and logs that. Does not
/// change values that the file already has.
void Housekeeping::keep_baseline(const LiveEstimation& live) {
  const estimator::Baseline* baseline = live.estimation().baseline();
  if (baseline == nullptr || written_baseline_.holds(*baseline)) return;
  const std::string& path = live.config().watch->baseline_path;
  if (path.empty()) return;
  const estimator::ParameterTable table = live.config().pipeline.parameters();
  std::string none;
  const std::string there = read_text_file(path, none).value_or("");
  const std::string text = there.empty()
                               ? baseline_text(*baseline, table)
                               : extended_baseline_text(there, written_baseline_, *baseline, table);
  written_baseline_ = *baseline;
  if (text == there) return;
  const std::string problem = drivers::write_text_file(path, text);
  if (problem.empty())
    log(LogLevel::notice, fmt::format("learned the baseline of {} parameters and wrote it to {}",
                                      baseline->known(), path));
  else
    log(LogLevel::error, fmt::format("cannot store the learned baseline: {}", problem));
}

service_t Housekeeping::service_report(const LiveEstimation& live,
                                       const std::vector<RaisedEvents*>& raised,
                                       std::int64_t now_us) const {
  const LiveTimes& times = live.times();
  service_t m{};
  m.time_us = now_us;
  m.started_us = started_us_;
  m.starts = starts_.starts;
  m.unclean_starts = starts_.unclean_starts;
  m.resumed = resumed_ ? 1 : 0;
  m.config = live.config().path;
  m.config_sha256 = live.config().sha256;
  m.version = FRAMEWATCH_VERSION;
  m.reloads = reloader_.count().done;
  m.reloads_refused = reloader_.count().refused;
  m.reload_problem = reloader_.count().problem;
  m.state_written_us = state_.written_us();
  m.state_problem = state_.problem();
  m.disk_free_bytes = state_.wanted() ? disk_free_bytes(state_.path()) : -1;
  const ProcessUsage usage = process_usage();
  m.resident_bytes = usage.resident_bytes;
  m.cpu_s = usage.cpu_s;
  m.received_us = times.received_us;
  m.deadline_missed = times.deadline_missed;
  m.step_sum_s = times.steps.sum_s();
  m.latency_sum_s = times.latencies.sum_s();
  m.limit_s.assign(DurationCounts::kLimit_s.begin(), DurationCounts::kLimit_s.end());
  m.steps.assign(times.steps.counts().begin(), times.steps.counts().end());
  m.latencies.assign(times.latencies.counts().begin(), times.latencies.counts().end());
  m.buckets = static_cast<std::int32_t>(m.limit_s.size());
  m.name = axis_names(live.config());
  m.newest_us = times.newest_us;
  m.channels = static_cast<std::int32_t>(m.name.size());
  for (const RaisedEvents* events : raised)
    for (const event_t& e : events->all()) {
      m.event_id.push_back(e.id);
      m.event_since_us.push_back(e.since_us);
      m.event_severity.push_back(e.severity);
      m.event_kind.push_back(e.kind);
      m.event_place.push_back(e.place);
      m.event_message.push_back(e.message);
    }
  m.raised = static_cast<std::int32_t>(m.event_id.size());
  return m;
}

bool Housekeeping::reload(LiveEstimation& live, ServiceManager& manager) {
  manager.reloading();
  auto next = reloader_.read(live.config());
  if (next) {
    live.reconfigure(std::move(next->config), next->reach);
    written_baseline_ = configured_baseline(live.config());
    gap_.reconfigure(live.config());
    state_.soon();
  }
  manager.ready();
  return next.has_value();
}

}  // namespace framewatch::daemon
