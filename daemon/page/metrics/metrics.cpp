#include "daemon/page/metrics/metrics.h"

#include <framewatch/action_status_t.hpp>
#include <framewatch/can_status_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/history_status_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/reception_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/uplink_status_t.hpp>
#include <framewatch/watch_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/base/process.h"
#include "daemon/page/metrics/metric_families.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kStiffnessChange = "stiffness_change";

}  // namespace

void Metrics::message(const std::string& channel, const void* data, std::size_t size,
                      std::int64_t now_us) {
  const std::string& prefix = config_.lcm.prefix;
  if (!channel.starts_with(prefix)) return;
  const std::string name = channel.substr(prefix.size());
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  if (name == "EVENT") {
    const auto e = drivers::decoded<event_t>({bytes, size});
    const std::lock_guard<std::mutex> lock(mutex_);
    if (e && !config_.watch && e->kind == kStiffnessChange) found_here_.note(*e);
    return;
  }
  for (const char* wanted : {"SERVICE", "STATUS", "PARAMETERS", "ESTIMATE", "GAP", "WATCH", "CAN",
                             "HISTORY", "ACTIONS", "RECEPTION", "UPLINK"}) {
    if (name != wanted) continue;
    const std::lock_guard<std::mutex> lock(mutex_);
    Newest& newest = newest_[name];
    newest.bytes.assign(bytes, bytes + size);
    newest.received_us = now_us;
  }
}

std::string Metrics::text(std::int64_t now_us, const PageUse& use) {
  std::map<std::string, std::vector<std::uint8_t>> fresh;
  RaisedEvents raised;
  std::optional<EventReportSummary> report;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto service = newest_.find("SERVICE");
    const bool up = service != newest_.end() && now_us - service->second.received_us <= kFresh_us;
    for (const auto& [name, newest] : newest_)
      if (now_us - newest.received_us <= kFresh_us ||
          (up && name != "ESTIMATE" && name != "UPLINK"))
        fresh[name] = newest.bytes;
    raised = found_here_;
    report = reports_.look();
  }
  const auto service = drivers::decoded<service_t>(fresh["SERVICE"]);
  const auto status = drivers::decoded<status_t>(fresh["STATUS"]);
  const auto table = drivers::decoded<parameter_table_t>(fresh["PARAMETERS"]);
  const auto estimate = drivers::decoded<window_estimate_t>(fresh["ESTIMATE"]);
  const auto gap = drivers::decoded<gap_t>(fresh["GAP"]);
  const auto watch = drivers::decoded<watch_t>(fresh["WATCH"]);
  const auto can = drivers::decoded<can_status_t>(fresh["CAN"]);
  const auto history = drivers::decoded<history_status_t>(fresh["HISTORY"]);
  const auto actions = drivers::decoded<action_status_t>(fresh["ACTIONS"]);
  const auto reception = drivers::decoded<reception_t>(fresh["RECEPTION"]);
  const auto uplink = drivers::decoded<uplink_status_t>(fresh["UPLINK"]);
  MetricFamilies out;
  out.gauge("up", "1: framewatch run has been heard of in the last 5 s.").value(service ? 1 : 0);
  if (service) {
    add_service(out, *service);
    for (std::size_t i = 0; i < service->event_id.size(); ++i) {
      event_t e{};
      e.id = service->event_id[i];
      e.state = 1;
      e.severity = service->event_severity[i];
      e.kind = service->event_kind[i];
      raised.note(e);
    }
  }
  if (status) add_status(out, *status);
  if (table && estimate) add_estimate(out, *table, *estimate);
  if (table && watch) add_watch(out, *table, *watch);
  if (gap) add_gap(out, *gap);
  if (can) add_can(out, *can);
  if (history) add_history(out, *history);
  if (actions) add_actions(out, *actions);
  if (reception) add_reception(out, *reception);
  if (config_.fleet)
    out.gauge("uplink_up", "1: framewatch uplink has been heard of in the last 5 s.")
        .value(uplink ? 1 : 0);
  if (uplink) add_uplink(out, *uplink);
  add_events(out, raised.all());
  if (config_.event_report) add_event_report(out, report);
  const ProcessUsage usage = process_usage();
  add_page_use(out, use);
  out.gauge("serve_resident_memory_bytes", "Memory of framewatch serve.")
      .value(static_cast<double>(usage.resident_bytes));
  out.counter("serve_cpu_seconds_total", "Processor time of framewatch serve.").value(usage.cpu_s);
  return out.text();
}

}  // namespace framewatch::daemon
