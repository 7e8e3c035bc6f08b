// SPDX-License-Identifier: MIT
#include "daemon/page/metrics/metrics.h"

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <framewatch/action_status_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/history_status_t.hpp>
#include <framewatch/mqtt_status_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/uplink_status_t.hpp>
#include <framewatch/watch_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/monitor/events/raised_events.h"
#include "daemon/monitor/live/live_estimation.h"
#include "daemon/monitor/service/service_manager.h"
#include "drivers/files/encoded.h"
#include "estimator/numeric/nan.h"
#include "estimator/state/archive.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace metrics_test {

template <typename Message>
void give(Metrics& metrics, const std::string& channel, const Message& message,
          std::int64_t now_us) {
  const std::vector<std::uint8_t> bytes = drivers::encoded(message);
  metrics.message(channel, bytes.data(), bytes.size(), now_us);
}

service_t service() {
  service_t m{};
  m.time_us = 100 * kSecond_us;
  m.starts = 4;
  m.unclean_starts = 1;
  m.config_sha256 = "ab";
  m.version = "1";
  m.disk_free_bytes = 5;
  m.buckets = 3;
  m.limit_s = {0.001, 0.01, std::numeric_limits<double>::infinity()};
  m.steps = {7, 2, 1};
  m.latencies = {0, 0, 0};
  m.step_sum_s = 0.5;
  m.channels = 2;
  m.name = {"base\"x", "F1"};
  m.newest_us = {3 * kSecond_us, 0};
  m.raised = 1;
  m.event_id = {3};
  m.event_since_us = {1};
  m.event_severity = {2};
  m.event_kind = {"stiffness_change"};
  m.event_place = {"kx_1_y1"};
  m.event_message = {"less"};
  return m;
}

void expect_line(const std::string& text, const std::string& line) {
  EXPECT_NE(("\n" + text).find("\n" + line + "\n"), std::string::npos) << line << "\nin\n" << text;
}

TEST(Metrics, AreUpOnlyWhileTheDaemonIsHeard) {
  const Config config{};
  Metrics metrics(config);
  expect_line(metrics.text(0, {}), "framewatch_up 0");
  give(metrics, "FRAMEWATCH_SERVICE", service(), 10 * kSecond_us);
  PageUse use;
  use.viewers = 2;
  use.waiting = 3;
  use.crowded_out = 5;
  const std::string up = metrics.text(10 * kSecond_us + Metrics::kFresh_us, use);
  expect_line(up, "framewatch_up 1");
  expect_line(up, "framewatch_serve_viewers 2");
  expect_line(up, "framewatch_serve_connections{state=\"request\"} 3");
  expect_line(up, "framewatch_serve_connections_ended_total{reason=\"crowded\"} 5");
  expect_line(up, "framewatch_starts_total 4");
  const std::string down = metrics.text(10 * kSecond_us + Metrics::kFresh_us + 1, {});
  expect_line(down, "framewatch_up 0");
  EXPECT_EQ(down.find("framewatch_starts_total"), std::string::npos);
}

TEST(Metrics, TellABrokerThatIsAway) {
  const Config config{};
  Metrics metrics(config);
  give(metrics, "FRAMEWATCH_SERVICE", service(), 0);
  EXPECT_EQ(metrics.text(0, {}).find("mqtt"), std::string::npos);
  mqtt_status_t m{};
  m.connected = 0;
  m.trouble = "Connection refused";
  m.messages = 4;
  m.dropped = 5;
  m.retained = 6;
  m.unreadable = 7;
  give(metrics, "FRAMEWATCH_MQTT", m, 0);
  const std::string text = metrics.text(0, {});
  expect_line(text, "framewatch_mqtt_connected 0");
  expect_line(text, "framewatch_mqtt_trouble 1");
  expect_line(text, "framewatch_mqtt_messages_total 4");
  expect_line(text, "framewatch_mqtt_messages_unused_total{reason=\"queue_full\"} 5");
  expect_line(text, "framewatch_mqtt_messages_unused_total{reason=\"retained\"} 6");
  expect_line(text, "framewatch_mqtt_messages_unused_total{reason=\"unreadable\"} 7");
}

TEST(Metrics, AddUpHistogramsEscapeLabelsAndOmitMissingValues) {
  const Config config{};
  Metrics metrics(config);
  give(metrics, "FRAMEWATCH_SERVICE", service(), 0);
  const std::string text = metrics.text(0, {});
  expect_line(text, "framewatch_step_duration_seconds_bucket{le=\"0.001\"} 7");
  expect_line(text, "framewatch_step_duration_seconds_bucket{le=\"0.01\"} 9");
  expect_line(text, "framewatch_step_duration_seconds_bucket{le=\"+Inf\"} 10");
  expect_line(text, "framewatch_step_duration_seconds_count 10");
  expect_line(text, R"(framewatch_channel_last_sample_timestamp_seconds{channel="base\"x"} 3)");
  EXPECT_EQ(text.find("last_sample_timestamp_seconds{channel=\"F1\"}"), std::string::npos);
  expect_line(text, R"(framewatch_events_raised{kind="stiffness_change",severity="alarm"} 1)");
  expect_line(text, R"(framewatch_events_raised{kind="gap",severity="warning"} 0)");
  expect_line(text, R"(framewatch_events_raised{kind="two_senders",severity="alarm"} 0)");
}

TEST(Metrics, EscapeForeignBytesInLabels) {
  const Config config{};
  Metrics metrics(config);
  service_t m = service();
  m.name = {"a\nframewatch_up 1\x1b\xff", "F1"};
  give(metrics, "FRAMEWATCH_SERVICE", m, kSecond_us);
  const std::string text = metrics.text(2 * kSecond_us, {});
  EXPECT_NE(text.find("a\\\\nframewatch_up 1\\\\x1b\\\\xff"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  EXPECT_EQ(text.find('\xff'), std::string::npos);
}

TEST(Metrics, OmitAndReportUnobservableValues) {
  const Config config{};
  Metrics metrics(config);
  parameter_table_t table{};
  table.parameters = 3;
  table.name = {"kx_1_y1", "Gk_1_x1y1", "cx_1_y1"};
  table.unit = {"N/m", "N/(rad*m)", "N*s/m"};
  table.kind = {0, 1, 2};
  table.story = {1, 1, 1};
  table.design = {1000, 10, 5};
  window_estimate_t estimate{};
  estimate.status = 1;
  estimate.residual_ratio = 0.25;
  estimate.parameters = 3;
  estimate.value = {900, estimator::kNaN, 4};
  estimate.std_error = {9, estimator::kNaN, 1};
  estimate.reason = {0, 3, 0};
  estimate.snr = {100, 1, 2};
  estimate.prior_share = estimate.noise_share = {0, 0, 0};
  give(metrics, "FRAMEWATCH_PARAMETERS", table, 0);
  give(metrics, "FRAMEWATCH_ESTIMATE", estimate, 0);
  const std::string text = metrics.text(0, {});
  const std::string frame = R"({parameter="kx_1_y1",story="1"} )";
  const std::string panel = R"({parameter="Gk_1_x1y1",story="1"} )";
  expect_line(text, "framewatch_frame_stiffness_newtons_per_meter" + frame + "900");
  expect_line(text, "framewatch_parameter_standard_error_ratio" + frame + "0.01");
  expect_line(text, "framewatch_parameter_valid" + panel + "0");
  EXPECT_EQ(text.find("panel_stiffness_newtons_per_radian_meter{"), std::string::npos);
  expect_line(text, "framewatch_window_valid 1");
  // The last window of a silent estimator must not stay forever.
  give(metrics, "FRAMEWATCH_SERVICE", service(), 9 * kSecond_us);
  EXPECT_EQ(metrics.text(9 * kSecond_us, {}).find("framewatch_window_valid"), std::string::npos);
}

TEST(Metrics, GiveTheBaseline) {
  const Config config{};
  Metrics metrics(config);
  parameter_table_t table{};
  table.parameters = 2;
  table.name = {"kx_1_y1", "Gk_1_x1y1"};
  table.unit = {"N/m", "N/rad"};
  table.kind = {0, 1};
  table.story = {1, 1};
  table.design = {1000, 5};
  watch_t watch{};
  watch.long_window_s = 3600;
  watch.quiet_learned_ratio = 1;
  watch.temperature_degc = estimator::kNaN;
  watch.parameters = 2;
  watch.watched = {1, 1};
  watch.baseline = {900, estimator::kNaN};
  watch.baseline_std_error = {9, estimator::kNaN};
  watch.baseline_degc = {8, estimator::kNaN};
  watch.quiet_baseline = {1000, 5};
  watch.quiet_std_error = {1, 1};
  watch.per_degc = {-0.002, estimator::kNaN};
  watch.per_degc_std_error = {1e-4, estimator::kNaN};
  watch.per_log_amplitude = watch.per_log_amplitude_std_error = {estimator::kNaN, estimator::kNaN};
  give(metrics, "FRAMEWATCH_PARAMETERS", table, 0);
  give(metrics, "FRAMEWATCH_WATCH", watch, 0);
  const std::string text = metrics.text(0, {});
  const std::string frame = R"({parameter="kx_1_y1",story="1"} )";
  expect_line(text, "framewatch_baseline" + frame + "900");
  expect_line(text, "framewatch_baseline_standard_error_ratio" + frame + "0.01");
  expect_line(text, "framewatch_quiet_baseline_per_degree_celsius_ratio" + frame + "-0.002");
  expect_line(text, "framewatch_quiet_baseline_learned_ratio 1");
  EXPECT_EQ(text.find("framewatch_baseline{parameter=\"Gk"), std::string::npos);
  EXPECT_EQ(text.find("framewatch_temperature_celsius "), std::string::npos);
}

TEST(Metrics, CountDataThatTheDiskRefuses) {
  const Config config{};
  Metrics metrics(config);
  history_status_t history{};
  history.summary_dropped = 4;
  history.summary_trouble = "disk I/O error";
  history.disk_free_bytes = -1;
  give(metrics, "FRAMEWATCH_HISTORY", history, 0);
  const std::string text = metrics.text(0, {});
  expect_line(text, R"(framewatch_history_dropped_total{kind="summary"} 4)");
  expect_line(text, R"(framewatch_history_trouble{kind="summary"} 1)");
  expect_line(text, R"(framewatch_history_trouble{kind="raw"} 0)");
  EXPECT_EQ(text.find("history_disk_free_bytes"), std::string::npos);
}

TEST(Metrics, CountMessagesThatWaitForTheHub) {
  Config config{};
  config.fleet.emplace();
  Metrics metrics(config);
  expect_line(metrics.text(0, {}), "framewatch_uplink_up 0");
  uplink_status_t uplink{};
  uplink.connected = 1;
  uplink.acknowledged_us = 1'700'000'000'000'000;
  uplink.events_waiting = 3;
  uplink.store_trouble = "disk I/O error";
  give(metrics, "FRAMEWATCH_UPLINK", uplink, 0);
  const std::string text = metrics.text(0, {});
  expect_line(text, "framewatch_uplink_up 1");
  expect_line(text, "framewatch_uplink_connected 1");
  expect_line(text, "framewatch_uplink_acknowledged_timestamp_seconds 1700000000");
  expect_line(text, R"(framewatch_uplink_waiting{kind="event"} 3)");
  expect_line(text, "framewatch_uplink_trouble 1");
  // A missing uplink must not look healthy because the daemon runs.
  give(metrics, "FRAMEWATCH_SERVICE", service_t{}, Metrics::kFresh_us + 1);
  expect_line(metrics.text(Metrics::kFresh_us + 1, {}), "framewatch_uplink_up 0");
}

TEST(Metrics, CountFailedNotifications) {
  const Config config{};
  Metrics metrics(config);
  action_status_t actions{};
  actions.ways = 1;
  actions.name = {"webhook"};
  actions.told = {5};
  actions.lost = {2};
  actions.merged = actions.lost_us = {0};
  actions.waiting = {1};
  actions.trouble = {"the server answers 500"};
  give(metrics, "FRAMEWATCH_ACTIONS", actions, 0);
  const std::string text = metrics.text(0, {});
  expect_line(text, R"(framewatch_action_events_total{way="webhook",result="told"} 5)");
  expect_line(text, R"(framewatch_action_events_total{way="webhook",result="lost"} 2)");
  expect_line(text, R"(framewatch_action_waiting_events{way="webhook"} 1)");
  expect_line(text, R"(framewatch_action_trouble{way="webhook"} 1)");
}

TEST(Metrics, IgnoreForeignAndDamagedMessages) {
  const Config config{};
  Metrics metrics(config);
  metrics.message("FRAMEWATCH_SERVICE", "garbage", 7, 0);
  metrics.message("FRAMEWATCH_STATUS", "", 0, 0);
  metrics.message("FRAMEWATCH_EVENT", "garbage", 7, 0);
  metrics.message("ACCEL", "garbage", 7, 0);
  expect_line(metrics.text(0, {}), "framewatch_up 0");
}

TEST(RaisedEvents, FollowRaisedChangedAndClearedEvents) {
  RaisedEvents raised;
  event_t e{};
  for (e.id = 1; e.id <= 3; ++e.id) {
    e.state = 1;
    raised.note(e);
  }
  e.id = 2;
  e.state = 2;
  e.value = 5;
  raised.note(e);
  ASSERT_EQ(raised.all().size(), 3u);
  EXPECT_EQ(raised.all()[1].value, 5);
  e.state = 0;
  raised.note(e);
  raised.note(e);
  EXPECT_EQ(raised.all().size(), 2u);

  estimator::StateWriter writer;
  writer(raised);
  estimator::StateReader reader(writer.bytes());
  RaisedEvents back;
  reader(back);
  EXPECT_TRUE(reader.whole());
  ASSERT_EQ(back.all().size(), 2u);
  EXPECT_EQ(back.all()[1].id, 3);
}

TEST(Metrics, GiveTheVerdictOfTheNewestReport) {
  const test::TemporaryDirectory directory;
  Config config{};
  EXPECT_EQ(Metrics(config).text(0, {}).find("event_report"), std::string::npos);
  config.event_report.emplace();
  config.event_report->directory = directory.path("");
  Metrics metrics(config);
  const std::string none = metrics.text(0, {});
  expect_line(none, "framewatch_event_report_color{color=\"red\"} 0");
  EXPECT_EQ(none.find("event_report_timestamp"), std::string::npos);
  test::write_file(
      directory.path("event-20261124T000000Z.json"),
      R"({"verdict": "red", "reasons": ["why"], "start_us": 5000000, "end_us": 9000000})");
  const std::string red = metrics.text(0, {});
  expect_line(red, "framewatch_event_report_color{color=\"red\"} 1");
  expect_line(red, "framewatch_event_report_color{color=\"green\"} 0");
  expect_line(red, "framewatch_event_report_timestamp_seconds 9");
}

TEST(DurationCounts, PutsEveryDurationIntoItsBin) {
  DurationCounts counts;
  for (const double s : {0.0, 1e-5, 1.1e-5, 0.02, 1.0, 1.5, 1e9}) counts.add(s);
  EXPECT_EQ(counts.counts().front(), 2);
  EXPECT_EQ(counts.counts()[1], 1);
  EXPECT_EQ(counts.counts()[10], 1);
  EXPECT_EQ(counts.counts()[counts.counts().size() - 2], 1);
  EXPECT_EQ(counts.counts().back(), 2);
}

TEST(StartCount, CountsStartsAfterACleanStopApart) {
  const test::TemporaryDirectory directory;
  const std::string state = directory.path("state");
  std::string problem;
  StartCount count = count_start(state, problem);
  EXPECT_EQ(problem, "");
  EXPECT_EQ(count.starts, 1);
  EXPECT_EQ(count.unclean_starts, 0);
  EXPECT_EQ(count_clean_stop(state, count), "");
  count = count_start(state, problem);
  EXPECT_EQ(count.unclean_starts, 0);
  count = count_start(state, problem);  // killed in between
  EXPECT_EQ(count.starts, 3);
  EXPECT_EQ(count.unclean_starts, 1);
  test::write_file(state + ".starts", "garbage 5\nstarts x");
  EXPECT_EQ(count_start(state, problem).starts, 1);
  EXPECT_NE(count_clean_stop("/nowhere/state", count), "");
}

}  // namespace metrics_test
}  // namespace framewatch::daemon
