// SPDX-License-Identifier: MIT
#include "daemon/monitor/live/service_report.h"

#include "daemon/base/clocks.h"
#include "daemon/base/process.h"
#include "daemon/config/channel_addresses.h"

namespace framewatch::daemon {

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

ServiceReport::ServiceReport(const StartCount& starts, bool resumed)
    : starts_(starts), resumed_(resumed), started_us_(host_clock_us()) {}

std::optional<service_t> ServiceReport::collect(const LiveEstimation& live,
                                                const std::vector<RaisedEvents*>& raised,
                                                const StateKeeper& state,
                                                const ReloadCount& reloads, std::int64_t now_us) {
  if (!second_.due(now_us)) return std::nullopt;
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
  m.reloads = reloads.done;
  m.reloads_refused = reloads.refused;
  m.reload_problem = reloads.problem;
  m.state_written_us = state.written_us();
  m.state_problem = state.problem();
  m.disk_free_bytes = state.wanted() ? disk_free_bytes(state.path()) : -1;
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

}  // namespace framewatch::daemon
