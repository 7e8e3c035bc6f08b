#include "drivers/message_types.h"

#include <gtest/gtest.h>

#include <framewatch/accel_counts_t.hpp>
#include <framewatch/accel_t.hpp>
#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>
#include <framewatch/action_status_t.hpp>
#include <framewatch/channel_table_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/history_status_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/temperature_t.hpp>
#include <framewatch/watch_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "drivers/accel_codec.h"
#include "drivers/channel_table.h"
#include "drivers/encoded.h"
#include "drivers/lcm_log.h"
#include "drivers/message_check.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace {

// The types as the first release has them. A log of its time decodes for ever: new fields are a new
// type. These numbers must never change.
constexpr std::uint64_t kAccel = 0xecb49719e8cabe05;

const std::string kFirstLog = FRAMEWATCH_SOURCE_DIR "/tests/golden/every_type.lcmlog";

accel_t accel() {
  accel_t m{};
  m.time_us = 1'700'000'000'123'456;
  m.sequence = 77;
  m.node = 3;
  m.accel_abs_mps2[0] = 0.125;
  m.accel_abs_mps2[1] = -9.75;
  m.accel_abs_mps2[2] = 1e-9;
  return m;
}

channel_table_t channel_table() {
  channel_table_t m{};
  m.time_us = 1;
  m.rate_hz = 100;
  m.channels = 2;
  m.name = {"base-x", "F1-Y1"};
  m.node = {0, 2};
  m.axis = {0, 1};
  return m;
}

parameter_table_t parameter_table() {
  parameter_table_t m{};
  m.time_us = 2;
  m.structure = "table";
  m.config_sha256 = "00ff";
  m.version = "0.1.0";
  m.rate_hz = 100;
  m.window_rows = 500;
  m.hop_rows = 1;
  m.boxplot_windows = 500;
  m.parameters = 2;
  m.name = {"kx_1_y1", "cx_1_y1"};
  m.unit = {"N/m", "N*s/m"};
  m.kind = {0, 2};
  m.story = {1, 1};
  m.design = {34e3, 53};
  m.other_windows = 1;
  m.other_channel = {"FRAMEWATCH_ESTIMATE_1S"};
  m.other_rows = {100};
  return m;
}

window_estimate_t window_estimate() {
  window_estimate_t m{};
  m.window_start_us = 10;
  m.window_end_us = 20;
  m.sequence = 5;
  m.status = 1;
  m.rows = 500;
  m.residual_ratio = 0.25;
  m.parameters = 2;
  m.value = {34000.5, 53.25};
  m.std_error = {12.5, 0.5};
  m.reason = {0, 2};
  m.snr = {100, 3};
  m.prior_share = {0, 0.5F};
  m.noise_share = {0.125F, 0};
  m.held = 1;
  m.held_index = {1};
  m.held_value = {53};
  m.held_std_error = {0.75};
  m.held_end_us = {15};
  m.boxplot_windows = 500;
  m.boxplots = 2;
  m.q1 = {1, 2};
  m.median = {3, 4};
  m.q3 = {5, 6};
  m.whisker_low = {0.5, 1.5};
  m.whisker_high = {7, 8};
  m.outliers = {0, 9};
  m.boxplot_count = {500, 499};
  return m;
}

status_t status() {
  status_t m{};
  m.time_us = 30;
  m.config_sha256 = "00ff";
  m.version = "0.1.0";
  m.windows = 1;
  m.sample_sets = 2;
  m.gaps = 3;
  m.rejected_messages = 4;
  m.queue_high_water = 5;
  m.queue_dropped = 6;
  m.latency_s = 0.5;
  m.channels = 1;
  m.name = {"base-x"};
  m.received = {7};
  m.lost = {8};
  m.late = {9};
  m.repaired = {10};
  m.rejected = {11};
  m.stuck = {12};
  m.clipped = {13};
  m.noise_mps2_per_rthz = {1e-4};
  return m;
}

event_t event() {
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

gap_t gap() {
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

can_status_t can_status() {
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

session_status_t session_status() {
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

session_command_t session_command() {
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

service_t service() {
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

accel_counts_t accel_counts() {
  accel_counts_t m{};
  m.time_us = 90;
  m.resolution_mps2 = 1e-6;
  m.samples = 3;
  m.offset_us = {0, -5, 10'000};
  m.channel = {0, 1, 0};
  m.count = {9'806'650, INT32_MIN, -1};
  return m;
}

history_status_t history_status() {
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

watch_t watch() {
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

temperature_t temperature() {
  temperature_t m{};
  m.time_us = 110;
  m.temperature_degc = -12.5;
  return m;
}

action_status_t action_status() {
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

acknowledge_t acknowledge() {
  acknowledge_t m{};
  m.request = 1;
  m.time_us = 120;
  m.id = 3;
  m.who = "me";
  m.comment = "a loose sensor";
  return m;
}

acknowledged_t acknowledged() {
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

std::vector<std::pair<std::string, std::vector<std::uint8_t>>> every_type() {
  return {{"ACCEL", encoded(accel())},
          {"ACCEL_CHANNELS", encoded(channel_table())},
          {"FRAMEWATCH_PARAMETERS", encoded(parameter_table())},
          {"FRAMEWATCH_ESTIMATE", encoded(window_estimate())},
          {"FRAMEWATCH_STATUS", encoded(status())},
          {"FRAMEWATCH_EVENT", encoded(event())},
          {"FRAMEWATCH_GAP", encoded(gap())},
          {"FRAMEWATCH_CAN", encoded(can_status())},
          {"FRAMEWATCH_SESSION", encoded(session_status())},
          {"FRAMEWATCH_SESSION_COMMAND", encoded(session_command())},
          {"FRAMEWATCH_SERVICE", encoded(service())},
          {"COUNTS", encoded(accel_counts())},
          {"FRAMEWATCH_HISTORY", encoded(history_status())},
          {"TEMPERATURE", encoded(temperature())},
          {"FRAMEWATCH_ACTIONS", encoded(action_status())},
          {"FRAMEWATCH_ACKNOWLEDGE", encoded(acknowledge())},
          {"FRAMEWATCH_ACKNOWLEDGED", encoded(acknowledged())},
          {"FRAMEWATCH_WATCH", encoded(watch())}};
}

TEST(Schema, ALogOfTheFirstReleaseDecodesToWhatWasWritten) {
  LcmLogReader reader;
  ASSERT_TRUE(reader.open(kFirstLog)) << reader.error();
  const auto messages = every_type();
  std::size_t i = 0;
  for (LogEvent e; reader.next(e) == LogRead::event; ++i) {
    ASSERT_LT(i, messages.size());
    EXPECT_EQ(e.channel, messages[i].first);
    EXPECT_EQ(e.timestamp_us, static_cast<std::int64_t>(1000 * i));
    EXPECT_TRUE(e.data == messages[i].second) << e.channel;
    EXPECT_STREQ(known_type(*fingerprint(e.data)), type_of_channel(e.channel));
    if (e.channel == "ACCEL") {
      const auto sample = decode_accel(e.data.data(), e.data.size());
      ASSERT_TRUE(sample);
      EXPECT_EQ(to_microseconds(sample->time), accel().time_us);
      EXPECT_EQ(sample->sequence, 77);
      EXPECT_EQ(sample->node, 3);
      EXPECT_EQ(sample->accel_abs_mps2, (std::array{0.125, -9.75, 1e-9}));
      EXPECT_EQ(accel_time_us(e.data.data(), e.data.size()), accel().time_us);
    }
    if (e.channel == "ACCEL_CHANNELS") {
      const auto table = decode_channel_table(e.data.data(), e.data.size());
      ASSERT_TRUE(table);
      EXPECT_EQ(table->entries[1], (ChannelTable::Entry{"F1-Y1", 2, 1}));
    }
    if (e.channel == "FRAMEWATCH_PARAMETERS") {
      const auto table = decode_parameter_table(e.data);
      ASSERT_TRUE(table);
      EXPECT_EQ(table->other_channel, parameter_table().other_channel);
      EXPECT_EQ(table->design, parameter_table().design);
    }
    if (e.channel == "FRAMEWATCH_ESTIMATE") {
      const auto estimate = decode_window_estimate(e.data);
      ASSERT_TRUE(estimate);
      EXPECT_EQ(estimate->value, window_estimate().value);
      EXPECT_EQ(estimate->boxplot_count, window_estimate().boxplot_count);
    }
    if (e.channel == "FRAMEWATCH_GAP") {
      EXPECT_EQ(decode_gap(e.data).value_or(gap_t{}).nrmse, gap().nrmse);
    }
    if (e.channel == "FRAMEWATCH_CAN") {
      const auto decoded = decode_can_status(e.data);
      ASSERT_TRUE(decoded);
      EXPECT_EQ(decoded->load, can_status().load);
      EXPECT_EQ(decoded->overflow, can_status().overflow);
    }
    if (e.channel == "FRAMEWATCH_SESSION") {
      const auto decoded = decode_session_status(e.data);
      ASSERT_TRUE(decoded);
      EXPECT_EQ(decoded->refused, session_status().refused);
      EXPECT_EQ(decoded->problem, session_status().problem);
    }
    if (e.channel == "FRAMEWATCH_SESSION_COMMAND") {
      EXPECT_EQ(decode_session_command(e.data).value_or(session_command_t{}).notes, "none");
    }
    if (e.channel == "FRAMEWATCH_SERVICE") {
      const auto decoded = decode_service(e.data);
      ASSERT_TRUE(decoded);
      EXPECT_EQ(decoded->latencies, service().latencies);
      EXPECT_EQ(decoded->newest_us, service().newest_us);
      EXPECT_EQ(decoded->event_message, service().event_message);
    }
    if (e.channel == "COUNTS") {
      const auto decoded = decode_accel_counts(e.data);
      ASSERT_TRUE(decoded);
      EXPECT_EQ(decoded->count, accel_counts().count);
      EXPECT_EQ(decoded->channel, accel_counts().channel);
    }
    if (e.channel == "FRAMEWATCH_HISTORY") {
      EXPECT_EQ(decode_history_status(e.data).value_or(history_status_t{}).summary_trouble,
                "disk I/O error");
    }
    if (e.channel == "TEMPERATURE") {
      EXPECT_EQ(decode_temperature(e.data).value_or(temperature_t{}).temperature_degc, -12.5);
    }
    if (e.channel == "FRAMEWATCH_WATCH") {
      const auto decoded = decode_watch(e.data);
      ASSERT_TRUE(decoded);
      EXPECT_EQ(decoded->watched, watch().watched);
      EXPECT_EQ(decoded->per_log_amplitude_std_error, watch().per_log_amplitude_std_error);
    }
    if (e.channel == "FRAMEWATCH_ACKNOWLEDGE") {
      EXPECT_EQ(decode_acknowledge(e.data).value_or(acknowledge_t{}).comment, "a loose sensor");
    }
    if (e.channel == "FRAMEWATCH_ACKNOWLEDGED") {
      EXPECT_EQ(decode_acknowledged(e.data).value_or(acknowledged_t{}).who, acknowledged().who);
    }
    if (e.channel == "FRAMEWATCH_ACTIONS") {
      EXPECT_EQ(decode_action_status(e.data).value_or(action_status_t{}).trouble,
                action_status().trouble);
    }
    if (e.channel == "FRAMEWATCH_EVENT") {
      const auto decoded = decode_event(e.data);
      ASSERT_TRUE(decoded);
      EXPECT_EQ(decoded->message, event().message);
      EXPECT_EQ(decoded->since_us, 35);
    }
  }
  EXPECT_EQ(i, messages.size());
}

TEST(Schema, FingerprintsAreThoseOfTheFirstRelease) {
  EXPECT_EQ(static_cast<std::uint64_t>(accel_t::getHash()), kAccel);
}

TEST(Schema, SaysWhatAPayloadIsInsteadOfWhatItShouldBe) {
  const auto bytes = encoded(accel());
  EXPECT_EQ(why_not("window_estimate_t", bytes), "accel_t where window_estimate_t belongs");
  auto longer = encoded(window_estimate());
  longer.push_back(0);
  EXPECT_NE(why_not("window_estimate_t", longer).find("its lengths do not fit"), std::string::npos);
  EXPECT_EQ(why_not("accel_t", std::vector<std::uint8_t>(3)), "3 bytes are no accel_t");
}

TEST(Schema, ANewerTypeIsCalledOne) {
  auto bytes = encoded(window_estimate());
  bytes[0] ^= 0x40;
  const std::string why = why_not("window_estimate_t", bytes);
  EXPECT_NE(why.find("no window_estimate_t as framewatch "), std::string::npos) << why;
  EXPECT_NE(why.find("a newer framewatch wrote them"), std::string::npos) << why;
  EXPECT_EQ(known_type(*fingerprint(bytes)), nullptr);
}

TEST(Schema, ChannelsTellTheirType) {
  EXPECT_STREQ(type_of_channel("ACCEL_ROOF"), "accel_t");
  EXPECT_STREQ(type_of_channel("ROOF_CHANNELS"), "channel_table_t");
  EXPECT_STREQ(type_of_channel("FRAMEWATCH_ESTIMATE_2.5S"), "window_estimate_t");
  EXPECT_STREQ(type_of_channel("B7_STATUS", "B7_"), "status_t");
  EXPECT_EQ(type_of_channel("CAMERA"), nullptr);
}

}  // namespace
}  // namespace framewatch::drivers
