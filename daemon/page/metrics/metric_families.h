// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <prometheus/metric_family.h>

#include <framewatch/action_status_t.hpp>
#include <framewatch/can_status_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/history_status_t.hpp>
#include <framewatch/mqtt_status_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/reception_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/uplink_status_t.hpp>
#include <framewatch/watch_t.hpp>
#include <framewatch/weather_status_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/monitor/event_report/event_report_files.h"

namespace framewatch::daemon {

/// Collects metrics for Prometheus, in the order of the calls.
class MetricFamilies {
 public:
  using Labels = std::vector<std::pair<std::string, std::string>>;

  /// Begins a metric. The next values belong to it.
  MetricFamilies& gauge(const char* name, const char* help);
  MetricFamilies& counter(const char* name, const char* help);
  template <typename Number>
  MetricFamilies& value(Number value, const Labels& labels = {}) {
    return add_value(static_cast<double>(value), labels);
  }
  /// Adds the finite values, each with its name in `label`. more: labels of every value.
  template <typename Values>
  MetricFamilies& each(const char* label, const std::vector<std::string>& names,
                       const Values& values, const Labels& more = {}) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!std::isfinite(static_cast<double>(values[i]))) continue;
      Labels labels{{label, names[i]}};
      labels.insert(labels.end(), more.begin(), more.end());
      value(values[i], labels);
    }
    return *this;
  }
  /// Adds a histogram. limit_s: upper limits, the last one infinite. counts: number of durations
  /// between two limits.
  void histogram(const char* name, const char* help, const std::vector<double>& limit_s,
                 const std::vector<std::int64_t>& counts, double sum_s);

  std::string text() const;

 private:
  MetricFamilies& family(const char* name, const char* help, prometheus::MetricType type);
  MetricFamilies& add_value(double value, const Labels& labels);

  std::vector<prometheus::MetricFamily> families_;
};

// Append the fields of a message as metrics.
void add_service(MetricFamilies& out, const service_t& service);
void add_status(MetricFamilies& out, const status_t& status);
void add_estimate(MetricFamilies& out, const parameter_table_t& table,
                  const window_estimate_t& estimate);
void add_watch(MetricFamilies& out, const parameter_table_t& table, const watch_t& watch);
void add_weather(MetricFamilies& out, const weather_status_t& weather);
void add_gap(MetricFamilies& out, const gap_t& gap);
void add_can(MetricFamilies& out, const can_status_t& can);
void add_mqtt(MetricFamilies& out, const mqtt_status_t& mqtt);
void add_history(MetricFamilies& out, const history_status_t& history);
void add_actions(MetricFamilies& out, const action_status_t& actions);
void add_reception(MetricFamilies& out, const reception_t& reception);
void add_uplink(MetricFamilies& out, const uplink_status_t& uplink);
void add_events(MetricFamilies& out, const std::vector<event_t>& raised);
/// report: the newest report of [event_report], if any.
void add_event_report(MetricFamilies& out, const std::optional<EventReportSummary>& report);

}  // namespace framewatch::daemon
