// SPDX-License-Identifier: MIT
#include "daemon/page/metrics/metric_families.h"

#include <algorithm>
#include <array>
#include <map>

#include <prometheus/text_serializer.h>

#include "daemon/base/printable.h"
#include "daemon/monitor/events/event_messages.h"

namespace framewatch::daemon {
namespace {

constexpr int kValid = 1;

/// Name and help of the metric by parameter_table_t::kind.
constexpr std::array<std::pair<const char*, const char*>, 4> kKinds = {{
    {"frame_stiffness_newtons_per_meter", "Stiffness of a frame in a story."},
    {"panel_stiffness_newtons_per_radian_meter", "Shear stiffness of a floor panel."},
    {"frame_damping_newton_seconds_per_meter", "Damping of a frame in a story."},
    {"panel_damping_newton_seconds_per_radian_meter", "Damping of a floor panel."},
}};

MetricFamilies::Labels labels_of(const parameter_table_t& table, std::size_t p) {
  return {{"parameter", table.name[p]}, {"story", std::to_string(table.story[p])}};
}

}  // namespace

MetricFamilies& MetricFamilies::family(const char* name, const char* help,
                                       prometheus::MetricType type) {
  families_.push_back({std::string("framewatch_") + name, help, type, {}});
  return *this;
}

MetricFamilies& MetricFamilies::gauge(const char* name, const char* help) {
  return family(name, help, prometheus::MetricType::Gauge);
}

MetricFamilies& MetricFamilies::counter(const char* name, const char* help) {
  return family(name, help, prometheus::MetricType::Counter);
}

MetricFamilies& MetricFamilies::add_value(double value, const Labels& labels) {
  prometheus::ClientMetric metric;
  for (const auto& [name, of] : labels) metric.label.push_back({name, printable(of)});
  metric.gauge.value = metric.counter.value = value;
  families_.back().metric.push_back(std::move(metric));
  return *this;
}

void MetricFamilies::histogram(const char* name, const char* help,
                               const std::vector<double>& limit_s,
                               const std::vector<std::int64_t>& counts, double sum_s) {
  family(name, help, prometheus::MetricType::Histogram);
  prometheus::ClientMetric metric;
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < limit_s.size(); ++i) {
    count += static_cast<std::uint64_t>(counts[i]);
    metric.histogram.bucket.push_back({count, limit_s[i]});
  }
  metric.histogram.sample_count = count;
  metric.histogram.sample_sum = sum_s;
  families_.back().metric.push_back(std::move(metric));
}

std::string MetricFamilies::text() const {
  return prometheus::TextSerializer().Serialize(families_);
}

void add_service(MetricFamilies& out, const service_t& s) {
  const auto seconds = [](std::int64_t us) { return 1e-6 * static_cast<double>(us); };
  out.gauge("build_info", "Always 1: which program runs with which configuration.")
      .value(1, {{"version", s.version}, {"config_sha256", s.config_sha256}});
  out.gauge("start_time_seconds", "Start of this framewatch run process, Unix time.")
      .value(seconds(s.started_us));
  if (s.starts > 0) {
    out.counter("starts_total", "Starts of framewatch run with its state file.").value(s.starts);
    out.counter("unclean_starts_total", "Starts after a run that ended without a stop signal.")
        .value(s.unclean_starts);
    out.gauge("resumed", "1: this process resumed from the state file; 0: it started afresh.")
        .value(s.resumed);
    out.gauge("state_write_failed", "1: the newest write of the state file failed.")
        .value(s.state_problem.empty() ? 0 : 1);
  }
  if (s.state_written_us > 0)
    out.gauge("state_written_timestamp_seconds", "When the state file was last written.")
        .value(seconds(s.state_written_us));
  if (s.disk_free_bytes >= 0)
    out.gauge("state_disk_free_bytes", "Free bytes on the disk of the state file.")
        .value(s.disk_free_bytes);
  out.counter("reloads_total", "Requested reloads of the configuration, by result.")
      .value(s.reloads, {{"result", "done"}})
      .value(s.reloads_refused, {{"result", "refused"}});
  out.gauge("config_last_reload_successful", "0: the newest reload was refused.")
      .value(s.reload_problem.empty() ? 1 : 0);
  out.gauge("resident_memory_bytes", "Memory of framewatch run.").value(s.resident_bytes);
  out.counter("cpu_seconds_total", "Processor time of framewatch run.").value(s.cpu_s);
  if (s.received_us > 0)
    out.gauge("last_sample_received_timestamp_seconds", "Arrival of the newest sample, host clock.")
        .value(seconds(s.received_us));
  out.gauge("channel_last_sample_timestamp_seconds",
            "Sensor time of the channel's newest sample; missing before the first.");
  std::int64_t newest_us = 0;
  for (std::size_t i = 0; i < s.name.size(); ++i) {
    newest_us = std::max(newest_us, s.newest_us[i]);
    if (s.newest_us[i] != 0) out.value(seconds(s.newest_us[i]), {{"channel", s.name[i]}});
  }
  if (s.received_us > 0)
    out.gauge("clock_offset_seconds", "Sensor clock minus host clock, transport included.")
        .value(seconds(newest_us - s.received_us));
  out.counter("deadline_missed_total", "Estimates later than the hop between two.")
      .value(s.deadline_missed);
  out.histogram("step_duration_seconds", "Time spent on one message or CAN frame.", s.limit_s,
                s.steps, s.step_sum_s);
  out.histogram("sample_to_estimate_latency_seconds",
                "From the arrival of the sample that completes a window to its estimate.",
                s.limit_s, s.latencies, s.latency_sum_s);
}

void add_status(MetricFamilies& out, const status_t& s) {
  out.counter("windows_total", "Estimates published.").value(s.windows);
  out.counter("sample_sets_total", "Instants given to the estimator.").value(s.sample_sets);
  out.counter("window_restarts_total", "Gaps that restarted the window.").value(s.gaps);
  out.counter("rejected_messages_total", "Undecodable, foreign or impossible input.")
      .value(s.rejected_messages);
  out.gauge("queue_high_water_messages", "Most messages that ever waited for the estimator.")
      .value(s.queue_high_water);
  out.counter("queue_dropped_total", "Messages lost to a full queue.").value(s.queue_dropped);
  out.counter("samples_total", "Samples received.").each("channel", s.name, s.received);
  out.counter("samples_lost_total", "Sequence numbers never seen.").each("channel", s.name, s.lost);
  out.counter("samples_repaired_total", "Single losses filled by interpolation.")
      .each("channel", s.name, s.repaired);
  out.counter("samples_unused_total", "Samples received and not used, by reason.");
  out.each("channel", s.name, s.clipped, {{"reason", "clipped"}})
      .each("channel", s.name, s.late, {{"reason", "late"}})
      .each("channel", s.name, s.rejected, {{"reason", "rejected"}})
      .each("channel", s.name, s.stuck, {{"reason", "stuck"}});
  out.gauge("channel_noise_mps2_per_root_hertz",
            "Noise density used, m/s^2/sqrt(Hz); missing while unknown.")
      .each("channel", s.name, s.noise_mps2_per_rthz);
}

void add_estimate(MetricFamilies& out, const parameter_table_t& table, const window_estimate_t& e) {
  if (table.name.size() != e.value.size()) return;
  const auto labels = [&](std::size_t p) { return labels_of(table, p); };
  const auto valid = [&](std::size_t p) { return e.reason[p] == 0 && std::isfinite(e.value[p]); };
  out.gauge("window_valid", "1: the newest window has values; 0: it is warming up or quiet.")
      .value(e.status == kValid ? 1 : 0);
  if (std::isfinite(e.residual_ratio))
    out.gauge("window_residual_ratio", "Rms of the residual over the rms of the response.")
        .value(e.residual_ratio);
  for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
    out.gauge(kKinds[kind].first, kKinds[kind].second);
    for (std::size_t p = 0; p < e.value.size(); ++p)
      if (valid(p) && table.kind[p] == static_cast<int>(kind)) out.value(e.value[p], labels(p));
  }
  out.gauge("parameter_valid", "1: the newest window has a value; 0: the value is missing above.");
  for (std::size_t p = 0; p < e.value.size(); ++p) out.value(valid(p) ? 1 : 0, labels(p));
  out.gauge("parameter_standard_error_ratio", "Standard error over the value.");
  for (std::size_t p = 0; p < e.value.size(); ++p)
    if (valid(p)) out.value(e.std_error[p] / e.value[p], labels(p));
  out.gauge("parameter_design_ratio", "Value over the design value the filters are tuned to.");
  for (std::size_t p = 0; p < e.value.size(); ++p)
    if (valid(p) && table.design[p] > 0) out.value(e.value[p] / table.design[p], labels(p));
  out.gauge("parameter_excitation_ratio", "Energy of the regressor over its noise energy.");
  for (std::size_t p = 0; p < e.value.size(); ++p)
    if (std::isfinite(e.snr[p])) out.value(e.snr[p], labels(p));
}

void add_watch(MetricFamilies& out, const parameter_table_t& table, const watch_t& w) {
  if (table.name.size() != w.watched.size()) return;
  const auto each = [&](const char* name, const char* help, const auto& value) {
    out.gauge(name, help);
    for (std::size_t p = 0; p < w.watched.size(); ++p)
      if (std::isfinite(value(p))) out.value(value(p), labels_of(table, p));
  };
  each("baseline", "Value that changes are measured against, in the parameter's unit.",
       [&](std::size_t p) { return w.baseline[p]; });
  each("baseline_standard_error_ratio", "Standard error of the baseline over the baseline.",
       [&](std::size_t p) { return w.baseline_std_error[p] / w.baseline[p]; });
  each("quiet_baseline", "Baseline of weak motion.",
       [&](std::size_t p) { return w.quiet_baseline[p]; });
  each("quiet_baseline_standard_error_ratio", "Standard error of the baseline over the baseline.",
       [&](std::size_t p) { return w.quiet_std_error[p] / w.quiet_baseline[p]; });
  each("quiet_baseline_per_degree_celsius_ratio",
       "Relative change of the baseline of weak motion per degree Celsius.",
       [&](std::size_t p) { return w.per_degc[p]; });
  each("quiet_baseline_per_log_amplitude_ratio",
       "Relative change of the baseline of weak motion with the logarithm of the amplitude.",
       [&](std::size_t p) { return w.per_log_amplitude[p]; });
  if (w.long_window_s > 0)
    out.gauge("quiet_baseline_learned_ratio",
              "Learned part of the baseline of weak motion, 0 to 1.")
        .value(w.quiet_learned_ratio);
  if (std::isfinite(w.temperature_degc))
    out.gauge("temperature_celsius", "Temperature that the thermometer measures.")
        .value(w.temperature_degc);
}

void add_weather(MetricFamilies& out, const weather_status_t& w) {
  std::vector<double> age_s;
  for (const std::int64_t us : w.value_us)
    age_s.push_back(us == 0 ? std::nan("") : 1e-6 * static_cast<double>(w.time_us - us));
  const auto each = [&](const std::vector<double>& values) {
    for (std::size_t c = 0; c < w.name.size(); ++c)
      if (std::isfinite(values[c])) out.value(values[c], {{"covariate", w.name[c]}});
  };
  out.gauge("weather", "Newest reading of a covariate, in the unit at the end of its name.");
  each(w.value);
  out.gauge("weather_age_seconds", "Time since that reading, of the sensors' clock.");
  each(age_s);
  out.counter("weather_rejected_total", "Readings that did not count.")
      .each("covariate", w.name, w.rejected);
}

void add_gap(MetricFamilies& out, const gap_t& g) {
  out.gauge("gap_ratio", "Gap between simulation and measurement, NRMSE over the last window.")
      .value(g.overall_nrmse);
  if (std::isfinite(g.noise_floor))
    out.gauge("gap_noise_floor_ratio", "Least gap that the sensor noise allows.")
        .value(g.noise_floor);
  out.gauge("channel_gap_ratio", "Gap of one channel.").each("channel", g.name, g.nrmse);
}

void add_can(MetricFamilies& out, const can_status_t& s) {
  out.gauge("can_bus_state", "1 for the state of the bus, 0 for the other states.");
  constexpr std::array kStates = {"gone", "active", "warning", "passive", "off"};  // from -1
  for (std::size_t b = 0; b < s.interface.size(); ++b)
    for (std::size_t state = 0; state < kStates.size(); ++state)
      out.value(s.state[b] + 1 == static_cast<int>(state) ? 1 : 0,
                {{"interface", s.interface[b]}, {"state", kStates[state]}});
  out.gauge("can_frames_per_second", "All frames on the bus.")
      .each("interface", s.interface, s.frames_hz);
  out.gauge("can_load_ratio", "Upper bound of the share of time that the bus is busy.")
      .each("interface", s.interface, s.load);
  out.gauge("can_expected_load_ratio",
            "Upper bound of the load expected from the configured nodes.")
      .each("interface", s.interface, s.expected_load);
  out.counter("can_error_frames_total", "Error frames.")
      .each("interface", s.interface, s.error_frames);
  out.counter("can_bus_off_total", "Times the bus was off.")
      .each("interface", s.interface, s.bus_off);
  out.counter("can_bus_errors_total", "Protocol, acknowledgement and transceiver errors.")
      .each("interface", s.interface, s.bus_errors);
  out.counter("can_overflow_total", "Overflows of the controller's receive buffer.")
      .each("interface", s.interface, s.overflow);
  out.counter("can_dropped_frames_total", "Frames lost to full receive queues of the host.")
      .value(s.dropped);
}

void add_mqtt(MetricFamilies& out, const mqtt_status_t& s) {
  out.gauge("mqtt_connected", "1: connected to the broker of [mqtt].").value(s.connected);
  out.gauge("mqtt_trouble", "1: not connected, or the broker refuses a topic.")
      .value(s.trouble.empty() ? 0 : 1);
  out.counter("mqtt_connections_total", "Connections that the broker accepted.")
      .value(s.connections);
  out.counter("mqtt_messages_total", "Messages received from the broker.").value(s.messages);
  out.counter("mqtt_messages_unused_total", "Messages that gave no reading, by reason.")
      .value(s.dropped, {{"reason", "queue_full"}})
      .value(s.retained, {{"reason", "retained"}})
      .value(s.unreadable, {{"reason", "unreadable"}});
}

void add_uplink(MetricFamilies& out, const uplink_status_t& s) {
  out.gauge("uplink_connected", "1: connected to a hub.").value(s.connected);
  out.gauge("uplink_acknowledged_timestamp_seconds",
            "Host clock of the newest acknowledgement of the hub, Unix time; 0: none yet.")
      .value(1e-6 * static_cast<double>(s.acknowledged_us));
  out.gauge("uplink_waiting", "Messages that the hub has not acknowledged, by kind.")
      .value(s.events_waiting, {{"kind", "event"}})
      .value(s.summaries_waiting, {{"kind", "summary"}})
      .value(s.pieces_waiting, {{"kind", "raw"}});
  out.counter("uplink_acknowledged_total", "Messages that the hub acknowledged.")
      .value(s.acknowledged);
  out.counter("uplink_sent_again_total", "Messages sent again because no acknowledgement came.")
      .value(s.sent_again);
  out.counter("uplink_refused_total", "Messages that the hub refused; they are kept.")
      .value(s.refused);
  out.counter("uplink_sent_bytes_total", "Bytes given to the network.").value(s.sent_bytes);
  out.counter("uplink_commands_total", "Commands of the hub.")
      .value(s.commands_obeyed, {{"result", "obeyed"}})
      .value(s.commands_refused, {{"result", "refused"}});
  out.gauge("uplink_trouble", "1: history or outbox cannot be read or written.")
      .value(s.store_trouble.empty() ? 0 : 1);
  out.gauge("uplink_resident_memory_bytes", "Memory of framewatch uplink.").value(s.resident_bytes);
  out.counter("uplink_cpu_seconds_total", "Processor time of framewatch uplink.").value(s.cpu_s);
}

void add_history(MetricFamilies& out, const history_status_t& s) {
  out.counter("history_samples_total", "Raw samples given to the history.").value(s.raw_samples);
  out.counter("history_dropped_total", "Dropped because the disk was too slow or failed, by kind.")
      .value(s.raw_dropped, {{"kind", "raw"}})
      .value(s.summary_dropped, {{"kind", "summary"}});
  out.counter("history_written_bytes_total", "Raw samples written, before compression.")
      .value(s.raw_bytes);
  out.gauge("history_queue_bytes", "Raw samples that wait for the disk.").value(s.raw_queue_bytes);
  out.gauge("history_trouble", "1: the history cannot be written.")
      .value(s.raw_trouble.empty() ? 0 : 1, {{"kind", "raw"}})
      .value(s.summary_trouble.empty() ? 0 : 1, {{"kind", "summary"}});
  out.gauge("history_stored_until_timestamp_seconds",
            "Windows that end before this sensor time are in the database.")
      .value(1e-6 * static_cast<double>(s.summary_until_us));
  out.gauge("history_stored_bytes", "Size of the history's directory.").value(s.stored_bytes);
  if (s.disk_free_bytes >= 0)
    out.gauge("history_disk_free_bytes", "Free bytes on the disk of the history.")
        .value(s.disk_free_bytes);
}

void add_actions(MetricFamilies& out, const action_status_t& s) {
  out.counter("action_events_total", "Events for which a notification was sent, or lost.")
      .each("way", s.name, s.told, {{"result", "told"}})
      .each("way", s.name, s.lost, {{"result", "lost"}});
  out.gauge("action_waiting_events", "Events whose notification waits.")
      .each("way", s.name, s.waiting);
  std::vector<int> trouble;
  for (const std::string& why : s.trouble) trouble.push_back(why.empty() ? 0 : 1);
  out.gauge("action_trouble", "1: the newest notification failed.").each("way", s.name, trouble);
}

void add_reception(MetricFamilies& out, const reception_t& r) {
  out.counter("messages_unused_total", "LCM datagrams and messages that were dropped, by reason.");
  for (const auto& [reason, count] : {std::pair{"elsewhere", r.datagrams_elsewhere},
                                      std::pair{"malformed", r.datagrams_malformed},
                                      std::pair{"overflowed", r.datagrams_overflowed},
                                      std::pair{"unfinished", r.messages_unfinished},
                                      std::pair{"queue_full", r.messages_dropped}})
    out.value(count, {{"reason", reason}});
}

/// Adds the size and error of the raised changes that have both.
void add_changes(MetricFamilies& out, const std::vector<event_t>& raised) {
  std::vector<const event_t*> sized;
  for (const event_t& e : raised)
    if (e.kind == "stiffness_change" && std::isfinite(e.value) && e.std_error > 0)
      sized.push_back(&e);
  if (sized.empty()) return;
  out.gauge("stiffness_change_ratio",
            "Size of a raised change relative to the baseline; negative: a loss.");
  for (const event_t* e : sized) out.value(e->value / 100, {{"parameter", e->place}});
  out.gauge("stiffness_change_error_ratio", "Standard error of the size of a raised change.");
  for (const event_t* e : sized) out.value(e->std_error / 100, {{"parameter", e->place}});
}

void add_events(MetricFamilies& out, const std::vector<event_t>& raised) {
  std::map<std::pair<std::string, std::string>, int> counts;
  // Always present, so that an alert sees the rise from 0.
  for (const char* severity : kSeverities) {
    counts[{"stiffness_change", severity}] = 0;
    counts[{"gap", severity}] = 0;
    counts[{"strong_motion", severity}] = 0;
    counts[{"two_senders", severity}] = 0;
    counts[{"channel_table", severity}] = 0;
  }
  for (const event_t& e : raised)
    if (e.severity >= 0 && e.severity < static_cast<int>(kSeverities.size()))
      ++counts[{e.kind, kSeverities[static_cast<std::size_t>(e.severity)]}];
  out.gauge("events_raised", "Events raised and not cleared.");
  for (const auto& [of, count] : counts)
    out.value(count, {{"kind", of.first}, {"severity", of.second}});
  add_changes(out, raised);
}

void add_event_report(MetricFamilies& out, const std::optional<EventReportSummary>& report) {
  out.gauge("event_report_color", "1 for the verdict of the newest report after strong motion.");
  for (const EventColor color : {EventColor::green, EventColor::yellow, EventColor::red})
    out.value(report && report->color == color ? 1 : 0, {{"color", color_word(color)}});
  if (report)
    out.gauge("event_report_timestamp_seconds",
              "Sensor time at which the strong motion of the newest report ended.")
        .value(1e-6 * static_cast<double>(report->end_us));
}

}  // namespace framewatch::daemon
