// SPDX-License-Identifier: MIT
#include "daemon/page/metrics/metrics.h"

#include "daemon/base/process.h"
#include "daemon/monitor/service/health.h"
#include "daemon/page/metrics/metric_families.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kStiffnessChange = "stiffness_change";

void add_page_use(MetricFamilies& out, const PageUse& use) {
  out.gauge("serve_viewers", "Open pages of framewatch serve.").value(use.viewers);
  out.gauge("serve_connections", "Connections of requests and answers, by state.")
      .value(use.waiting, {{"state", "request"}})
      .value(use.answering, {{"state", "answer"}});
  out.counter("serve_connections_ended_total", "Connections ended by framewatch serve, by reason.")
      .value(use.late_requests, {{"reason", "late_request"}})
      .value(use.late_answers, {{"reason", "late_answer"}})
      .value(use.crowded_out, {{"reason", "crowded"}});
  out.counter("serve_viewers_refused_total", "Viewers refused because all places were taken.")
      .value(use.viewers_refused);
}

}  // namespace

void Metrics::message(const std::string& channel, const void* data, std::size_t size,
                      std::int64_t now_us) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto changed = latest_.update(channel, {static_cast<const std::uint8_t*>(data), size});
  if (!changed) return;
  received_us_[*changed] = now_us;
  if (changed == DaemonMessage::event && !config_.watch && latest_.event->kind == kStiffnessChange)
    found_here_.note(*latest_.event);
}

std::string Metrics::text(std::int64_t now_us, const PageUse& use) {
  std::unique_lock<std::mutex> lock(mutex_);
  LatestMessages fresh = latest_;
  const auto is_fresh = [&](DaemonMessage message) {
    const auto at = received_us_.find(message);
    return at != received_us_.end() && now_us - at->second <= kFresh_us;
  };
  const bool up = is_fresh(DaemonMessage::service);
  for (const auto& [message, at_us] : received_us_)
    if (!is_fresh(message) &&
        (!up || message == DaemonMessage::estimate || message == DaemonMessage::uplink))
      fresh.forget(message);
  RaisedEvents raised = found_here_;
  const std::optional<EventReportSummary> report = reports_.poll();
  lock.unlock();
  MetricFamilies out;
  out.gauge("up", "1: framewatch run has published in the last 5 s.").value(fresh.service ? 1 : 0);
  if (fresh.service) {
    add_service(out, *fresh.service);
    for (std::size_t i = 0; i < fresh.service->event_id.size(); ++i)
      raised.note(raised_event(*fresh.service, i));
  }
  if (fresh.status) add_status(out, *fresh.status);
  if (fresh.parameters && fresh.estimate) add_estimate(out, *fresh.parameters, *fresh.estimate);
  if (fresh.parameters && fresh.watch) add_watch(out, *fresh.parameters, *fresh.watch);
  if (fresh.weather) add_weather(out, *fresh.weather);
  if (fresh.gap) add_gap(out, *fresh.gap);
  if (fresh.can) add_can(out, *fresh.can);
  if (fresh.mqtt) add_mqtt(out, *fresh.mqtt);
  if (fresh.history) add_history(out, *fresh.history);
  if (fresh.actions) add_actions(out, *fresh.actions);
  if (fresh.reception) add_reception(out, *fresh.reception);
  if (config_.fleet)
    out.gauge("uplink_up", "1: framewatch uplink has published in the last 5 s.")
        .value(fresh.uplink ? 1 : 0);
  if (fresh.uplink) add_uplink(out, *fresh.uplink);
  add_events(out, raised.all());
  if (config_.event_report) add_event_report(out, report);
  const ProcessUsage usage = process_usage();
  add_page_use(out, use);
  out.gauge("serve_resident_memory_bytes", "Memory of framewatch serve.")
      .value(usage.resident_bytes);
  out.counter("serve_cpu_seconds_total", "Processor time of framewatch serve.").value(usage.cpu_s);
  return out.text();
}

}  // namespace framewatch::daemon
