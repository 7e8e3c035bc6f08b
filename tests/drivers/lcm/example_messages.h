// SPDX-License-Identifier: MIT
#pragma once

#include <framewatch/accel_counts_t.hpp>
#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>
#include <framewatch/action_status_t.hpp>
#include <framewatch/can_status_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/history_status_t.hpp>
#include <framewatch/model_fit_t.hpp>
#include <framewatch/mqtt_status_t.hpp>
#include <framewatch/reception_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/session_command_t.hpp>
#include <framewatch/session_status_t.hpp>
#include <framewatch/temperature_t.hpp>
#include <framewatch/watch_t.hpp>
#include <framewatch/weather_status_t.hpp>
#include <framewatch/weather_t.hpp>

#include "tests/drivers/lcm/example_estimates.h"
#include "tests/drivers/lcm/example_fleet.h"

// One message of every type in lcmtypes/, as in tests/golden/every_type.lcmlog and in its order.
namespace framewatch::drivers::examples {

inline event_t event() {
  event_t m{};
  m.time_us = 40;
  m.since_us = 35;
  m.id = 1;
  m.state = 1;
  m.severity = 2;
  m.kind = "stiffness_change";
  m.place = "kx_1_y1";
  m.value = -0.03;
  m.std_error = 0.01;
  m.unit = "1";
  m.message = "kx_1_y1 is 3 % less";
  m.segment = "";
  return m;
}

inline gap_t gap() {
  gap_t m{};
  m.window_start_us = 50;
  m.window_end_us = 60;
  m.overall_nrmse = 0.1;
  m.noise_floor = 0.01;
  m.channels = 1;
  m.name = {"base-x"};
  m.nrmse = {0.2};
  m.floor = {0.02};
  return m;
}

inline model_fit_t model_fit() {
  model_fit_t m{};
  m.window_start_us = 50;
  m.window_end_us = 60;
  m.sequence = 3;
  m.parameters = 2;
  m.misfit = {0.02, 0.4};
  m.design_error = {0.01, 0.02};
  m.misfit_error = {0.005, 0.3};
  m.corner_error = {0, 0.25};
  m.error = {0.0125, 1};
  m.word = {1, 3};
  return m;
}

inline can_status_t can_status() {
  can_status_t m{};
  m.time_us = 70;
  m.dropped = 1;
  m.buses = 1;
  m.interface = {"can0"};
  m.state = {2};
  m.frames_hz = {800};
  m.load = {0.25};
  m.expected_load = {0.125};
  m.error_frames = {3};
  m.bus_off = {4};
  m.bus_errors = {5};
  m.overflow = {6};
  return m;
}

inline session_status_t session_status() {
  session_status_t m{};
  m.time_us = 80;
  m.state = 3;
  m.test = "sweep";
  m.session = "2026-11-21T14-03-10_sweep";
  m.message = "triggered by base-x";
  m.answered = 9;
  m.refused = "no";
  m.elapsed_s = 1.5;
  m.length_s = 60;
  m.trigger_mps2 = 0.25;
  m.messages = 10;
  m.estimates = 11;
  m.lost = 12;
  m.dropped = 13;
  m.bytes = 14;
  m.disk_free_bytes = -1;
  m.channels = 1;
  m.name = {"base-x"};
  m.noise_mps2_per_rthz = {5e-4};
  m.rms_mps2 = {0.5};
  m.offset_mps2 = {-0.5};
  m.peak_mps2 = {2};
  m.range_mps2 = {20};
  m.saturated = {7};
  m.polarity = {-1};
  m.problem = {"reversed"};
  return m;
}

inline session_command_t session_command() {
  session_command_t m{};
  m.id = 9;
  m.verb = "arm";
  m.test = "sweep";
  m.operator_name = "me";
  m.notes = "none";
  m.length_s = 60;
  m.trigger_mps2 = 0.25;
  m.pre_trigger_s = 5;
  return m;
}

inline service_t service() {
  service_t m{};
  m.time_us = 90;
  m.started_us = 1;
  m.starts = 2;
  m.unclean_starts = 3;
  m.resumed = 1;
  m.config = "b.toml";
  m.config_sha256 = "00ff";
  m.version = "0.1.0";
  m.reloads = 4;
  m.reloads_refused = 5;
  m.reload_problem = "b.toml:3";
  m.state_written_us = 6;
  m.state_problem = "No space left on device";
  m.disk_free_bytes = 7;
  m.resident_bytes = 8;
  m.cpu_s = 0.5;
  m.received_us = 9;
  m.deadline_missed = 10;
  m.step_sum_s = 0.25;
  m.latency_sum_s = 0.125;
  m.buckets = 2;
  m.limit_s = {0.001, 1e300};
  m.steps = {11, 12};
  m.latencies = {13, 14};
  m.channels = 1;
  m.name = {"base-x"};
  m.newest_us = {15};
  m.raised = 1;
  m.event_id = {16};
  m.event_since_us = {17};
  m.event_severity = {2};
  m.event_kind = {"gap"};
  m.event_place = {"F1-Y1"};
  m.event_message = {"differ"};
  return m;
}

inline accel_counts_t accel_counts() {
  accel_counts_t m{};
  m.time_us = 90;
  m.resolution_mps2 = 1e-6;
  m.samples = 3;
  m.offset_us = {0, -5, 10'000};
  m.channel = {0, 1, 0};
  m.count = {9'806'650, INT32_MIN, -1};
  return m;
}

inline history_status_t history_status() {
  history_status_t m{};
  m.time_us = 100;
  m.directory = "history";
  m.raw_samples = 1;
  m.raw_dropped = 2;
  m.raw_bytes = 3;
  m.raw_queue_bytes = 4;
  m.raw_trouble = "No space left on device";
  m.summary_commits = 5;
  m.summary_until_us = 6;
  m.summary_dropped = 7;
  m.summary_trouble = "disk I/O error";
  m.stored_bytes = 8;
  m.disk_free_bytes = -1;
  return m;
}

inline watch_t watch() {
  watch_t m{};
  m.time_us = 140;
  m.long_window_s = 3600;
  m.quiet_learned_ratio = 0.25;
  m.temperature_degc = 7;
  m.parameters = 2;
  m.watched = {1, 0};
  m.baseline = {1e4, 2};
  m.baseline_std_error = {30, 0.5};
  m.baseline_degc = {8, 9};
  m.quiet_baseline = {1.1e4, 3};
  m.quiet_std_error = {20, 0.25};
  m.per_degc = {-0.001, 0};
  m.per_degc_std_error = {1e-4, 2e-4};
  m.per_log_amplitude = {-0.02, 0.01};
  m.per_log_amplitude_std_error = {1e-3, 2e-3};
  return m;
}

inline temperature_t temperature() {
  temperature_t m{};
  m.time_us = 110;
  m.temperature_degc = -12.5;
  return m;
}

inline weather_t weather() {
  weather_t m{};
  m.time_us = 110;
  m.name = "humidity_pct";
  m.value = 81.5;
  return m;
}

inline weather_status_t weather_status() {
  weather_status_t m{};
  m.time_us = 120;
  m.covariates = 2;
  m.name = {"outside_degc", "humidity_pct"};
  m.value = {-12.5, 81.5};
  m.value_us = {110, 100};
  m.mean = {-12.25, std::numeric_limits<double>::quiet_NaN()};
  m.mean_us = {110, 0};
  m.accepted = {7, 8};
  m.rejected = {1, 0};
  return m;
}

inline action_status_t action_status() {
  action_status_t m{};
  m.time_us = 110;
  m.ways = 2;
  m.name = {"command", "webhook"};
  m.told = {1, 2};
  m.lost = {3, 4};
  m.merged = {5, 6};
  m.waiting = {7, 8};
  m.lost_us = {0, 105};
  m.trouble = {"", "webhook: the server answers 500"};
  return m;
}

inline acknowledge_t acknowledge() {
  acknowledge_t m{};
  m.request = 1;
  m.time_us = 120;
  m.id = 3;
  m.who = "me";
  m.comment = "a loose sensor";
  return m;
}

inline acknowledged_t acknowledged() {
  acknowledged_t m{};
  m.time_us = 121;
  m.answered = 1;
  m.refused = "no event 4 is raised";
  m.events = 2;
  m.id = {3, 5};
  m.kind = {"gap", "stiffness_change"};
  m.place = {"F1-Y1", "kx_1_y1"};
  m.since_us = {120, 90};
  m.who = {"me", "you"};
  m.comment = {"a loose sensor", ""};
  return m;
}

inline reception_t reception() {
  reception_t m{};
  m.time_us = 1;
  m.datagrams_elsewhere = 2;
  m.datagrams_malformed = 3;
  m.datagrams_overflowed = 4;
  m.messages_unfinished = 5;
  m.messages_dropped = 6;
  return m;
}

inline mqtt_status_t mqtt_status() {
  mqtt_status_t m{};
  m.time_us = 1;
  m.broker = "mqtts://broker.example.org";
  m.connected = 1;
  m.since_us = 2;
  m.trouble = "the broker refuses the topic roof";
  m.connections = 3;
  m.messages = 4;
  m.dropped = 5;
  m.retained = 6;
  m.unreadable = 7;
  m.unread = "roof: \"on\" is not a number";
  return m;
}

/// Calls visit(LCM channel, message) for each message.
template <typename Visit>
void for_each(Visit visit) {
  visit("ACCEL", accel());
  visit("ACCEL_CHANNELS", channel_table());
  visit("FRAMEWATCH_PARAMETERS", parameter_table());
  visit("FRAMEWATCH_ESTIMATE", window_estimate());
  visit("FRAMEWATCH_STATUS", status());
  visit("FRAMEWATCH_EVENT", event());
  visit("FRAMEWATCH_GAP", gap());
  visit("FRAMEWATCH_CAN", can_status());
  visit("FRAMEWATCH_SESSION", session_status());
  visit("FRAMEWATCH_SESSION_COMMAND", session_command());
  visit("FRAMEWATCH_SERVICE", service());
  visit("COUNTS", accel_counts());
  visit("FRAMEWATCH_HISTORY", history_status());
  visit("TEMPERATURE", temperature());
  visit("FRAMEWATCH_ACTIONS", action_status());
  visit("FRAMEWATCH_ACKNOWLEDGE", acknowledge());
  visit("FRAMEWATCH_ACKNOWLEDGED", acknowledged());
  visit("FRAMEWATCH_WATCH", watch());
  visit("FRAMEWATCH_RECEPTION", reception());
  visit("FRAMEWATCH_MODEL_FIT", model_fit());
  visit("FRAMEWATCH_SUMMARY", summary());
  visit("FRAMEWATCH_UPLINK", uplink_status());
  visit("WEATHER", weather());
  visit("FRAMEWATCH_WEATHER", weather_status());
  visit("FRAMEWATCH_MQTT", mqtt_status());
}

}  // namespace framewatch::drivers::examples
