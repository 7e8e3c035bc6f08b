#include "daemon/page/metrics/metric_families.h"

#include <algorithm>

#include <prometheus/text_serializer.h>

#include "daemon/base/printable.h"

namespace framewatch::daemon {

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

MetricFamilies& MetricFamilies::value(double value, const Labels& labels) {
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
  const auto number = [](std::int64_t n) { return static_cast<double>(n); };
  out.gauge("build_info", "Always 1: which program runs with which configuration.")
      .value(1, {{"version", s.version}, {"config_sha256", s.config_sha256}});
  out.gauge("start_time_seconds", "When this process of framewatch run began, Unix time.")
      .value(seconds(s.started_us));
  if (s.starts > 0) {
    out.counter("starts_total", "Starts of framewatch run with its state file.")
        .value(number(s.starts));
    out.counter("unclean_starts_total", "Starts after a run that nobody had told to stop.")
        .value(number(s.unclean_starts));
    out.gauge("resumed", "1: this process went on from the state file; 0: it began anew.")
        .value(s.resumed);
    out.gauge("state_write_failed", "1: the newest write of the state file failed.")
        .value(s.state_problem.empty() ? 0 : 1);
  }
  if (s.state_written_us > 0)
    out.gauge("state_written_timestamp_seconds", "When the state file was last written.")
        .value(seconds(s.state_written_us));
  if (s.disk_free_bytes >= 0)
    out.gauge("state_disk_free_bytes", "Free where the state file goes.")
        .value(number(s.disk_free_bytes));
  out.counter("reloads_total", "Times the configuration was asked to be read anew.")
      .value(number(s.reloads), {{"result", "done"}})
      .value(number(s.reloads_refused), {{"result", "refused"}});
  out.gauge("config_last_reload_successful", "0: the newest reload was refused.")
      .value(s.reload_problem.empty() ? 1 : 0);
  out.gauge("resident_memory_bytes", "Memory of framewatch run.").value(number(s.resident_bytes));
  out.counter("cpu_seconds_total", "Processor time of framewatch run.").value(s.cpu_s);
  if (s.received_us > 0)
    out.gauge("last_sample_received_timestamp_seconds", "When any sample last came, host clock.")
        .value(seconds(s.received_us));
  out.gauge("channel_last_sample_timestamp_seconds",
            "Sensor time of the channel's newest sample; none while none has come.");
  std::int64_t newest_us = 0;
  for (std::size_t i = 0; i < s.name.size(); ++i) {
    newest_us = std::max(newest_us, s.newest_us[i]);
    if (s.newest_us[i] != 0) out.value(seconds(s.newest_us[i]), {{"channel", s.name[i]}});
  }
  if (s.received_us > 0)
    out.gauge("clock_offset_seconds", "Sensor clock minus host clock, transport included.")
        .value(seconds(newest_us - s.received_us));
  out.counter("deadline_missed_total", "Estimates later than the hop between two.")
      .value(number(s.deadline_missed));
  out.histogram("step_duration_seconds", "Time spent on one message or CAN frame.", s.limit_s,
                s.steps, s.step_sum_s);
  out.histogram("sample_to_estimate_latency_seconds",
                "From the arrival of the sample that completes a window to its estimate.",
                s.limit_s, s.latencies, s.latency_sum_s);
}

void add_status(MetricFamilies& out, const status_t& s) {
  const auto number = [](std::int64_t n) { return static_cast<double>(n); };
  out.counter("windows_total", "Estimates published.").value(number(s.windows));
  out.counter("sample_sets_total", "Instants given to the estimator.").value(number(s.sample_sets));
  out.counter("window_restarts_total", "Gaps that restarted the window.").value(number(s.gaps));
  out.counter("rejected_messages_total", "Undecodable, foreign or impossible input.")
      .value(number(s.rejected_messages));
  out.gauge("queue_high_water_messages", "Most messages that ever waited for the estimator.")
      .value(s.queue_high_water);
  out.counter("queue_dropped_total", "Messages lost to a full queue.")
      .value(number(s.queue_dropped));
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
            "Noise density reckoned with, m/s^2/sqrt(Hz); none while it is not known.")
      .each("channel", s.name, s.noise_mps2_per_rthz);
}

}  // namespace framewatch::daemon
