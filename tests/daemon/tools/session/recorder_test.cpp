// SPDX-License-Identifier: MIT
#include "daemon/tools/session/recorder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <framewatch/session_command_t.hpp>
#include <framewatch/temperature_t.hpp>

#include "daemon/tools/report/session_file.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/daemon/tools/session/recorder_bench.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace recorder_test {

// Limits.
constexpr std::int64_t kInstant_us = 10'000;          // largest delay of a trigger
constexpr std::int64_t kOverPreTrigger_us = 700'000;  // samples from before the pre-trigger time

using drivers::LcmLogReader;
using drivers::LogEvent;
using drivers::LogRead;

double at_rest(double t) {
  return 1e-3 * std::sin(50 * t);
}

TEST(Recorder, ATriggerRecordsTheSecondsBeforeItAndEndsAtItsLength) {
  test::RecorderBench b;
  b.play(0, 4, at_rest);
  ASSERT_TRUE(b.recorder.checked());
  SessionRequest request{"sweep 1", "me", "", 3, 0.2, 1.5};
  ASSERT_EQ(b.recorder.begin(request, 4'000'000), "");
  EXPECT_EQ(b.recorder.state(), RecorderState::armed);
  b.play(4, 6, at_rest);
  EXPECT_EQ(b.recorder.state(), RecorderState::armed);
  b.play(6, 12, [](double t) { return std::sin(20 * (t - 6)); });
  EXPECT_EQ(b.recorder.state(), RecorderState::waiting);
  ASSERT_EQ(b.ended.size(), 1u);
  EXPECT_NE(b.ended[0].find("_sweep-1"), std::string::npos);
  const auto times = test::times_of(b.ended[0] + "/raw.lcmlog");
  std::string error;
  const auto session = read_session_file(b.ended[0] + "/session.json", error);
  ASSERT_TRUE(session) << error;
  // 0.2 of a 1 m/s^2 sine of 20 rad/s: 10 ms after 6 s.
  EXPECT_NEAR(static_cast<double>(session->trigger_us), 6'010'000, 2 * kInstant_us);
  EXPECT_LE(times.front(), session->trigger_us - 1'500'000);
  EXPECT_GT(times.front(), session->trigger_us - 1'500'000 - kOverPreTrigger_us);
  EXPECT_GE(times.back(), session->trigger_us + 3'000'000);
  EXPECT_EQ(session->triggered_by, "base-x");
  EXPECT_EQ(session->ended_by, "length");
  EXPECT_EQ(session->messages, static_cast<std::int64_t>(times.size()));
  EXPECT_EQ(session->lost + session->dropped, 0);
  // Contains every sample of every node in between.
  std::map<std::int64_t, int> nodes;
  for (const std::int64_t t : times) ++nodes[t];
  for (std::int64_t t = times.front() + kInstant_us; t < times.back(); t += kInstant_us)
    EXPECT_EQ(nodes[t], 10) << t;
  EXPECT_NEAR(session->run[0].peak, 1, 0.01);
  EXPECT_LT(session->check[0].peak, 0.01);
}

TEST(Recorder, StoresATemperatureAmongTheSamples) {
  test::RecorderBench b;
  b.config.watch.emplace().temperature_channel = "OUTSIDE";
  const auto channels = b.recorder.channels();
  EXPECT_EQ(std::count(channels.begin(), channels.end(), "OUTSIDE"), 1);
  ASSERT_EQ(b.recorder.begin({"t", "me", "", 0, 0, 0}, 0), "");
  b.play(0, 1, at_rest);
  const auto bytes = drivers::encoded(temperature_t{1'000'000, 21.5});
  b.recorder.message("OUTSIDE", bytes.data(), bytes.size(), 1'000'500);
  b.play(1, 2, at_rest);
  ASSERT_EQ(b.recorder.stop("asked", 2'000'000), "");
  b.recorder.tick(10'000'000);
  LcmLogReader reader;
  ASSERT_EQ(b.ended.size(), 1u);
  ASSERT_TRUE(reader.open(b.ended[0] + "/raw.lcmlog"));
  std::int64_t before = 0, after = 0, heard = 0;
  for (LogEvent e; reader.next(e) == LogRead::event;) {
    if (e.channel == "OUTSIDE") ++heard;
    if (e.channel == "ACCEL") ++(heard == 0 ? before : after);
  }
  EXPECT_EQ(heard, 1);
  EXPECT_EQ(before, 1000);
  EXPECT_EQ(after, 1000);
}

TEST(Recorder, ObeysCommandsOnceAndRefusesWithAReason) {
  test::RecorderBench b;
  b.play(0, 4, at_rest);
  session_command_t c{};
  const auto tell = [&](std::int64_t id, const char* verb, double level) {
    c.id = id;
    c.verb = verb;
    c.trigger_mps2 = level;
    b.recorder.obey(c, "alice", 4'000'000);
    return b.recorder.status(4'000'000).refused;
  };
  EXPECT_NE(tell(1, "stop", 0), "");
  EXPECT_NE(tell(2, "arm", 0), "");
  EXPECT_NE(tell(3, "explode", 0), "");
  EXPECT_EQ(tell(4, "arm", 0.3), "");
  EXPECT_EQ(b.recorder.state(), RecorderState::armed);
  EXPECT_EQ(tell(5, "stop", 0), "");
  EXPECT_EQ(b.recorder.state(), RecorderState::waiting);
  EXPECT_EQ(tell(6, "start", 0), "");
  EXPECT_EQ(b.recorder.state(), RecorderState::recording);
  EXPECT_NE(tell(7, "start", 0), "");
  EXPECT_NE(tell(8, "tap", 0), "");
  EXPECT_EQ(tell(9, "stop", 0), "");
  EXPECT_EQ(tell(9, "stop", 0), "");  // sent again, but not obeyed again
  b.play(4, 5, at_rest);
  EXPECT_EQ(b.recorder.state(), RecorderState::waiting);
  ASSERT_EQ(b.ended.size(), 1u);
  std::string why;
  EXPECT_EQ(read_session_file(b.ended[0] + "/" + kSessionJson, why)->asked_by, "alice") << why;
  c.notes.assign(5000, 'x');
  EXPECT_NE(tell(10, "start", 0), "");
  EXPECT_EQ(b.recorder.status(0).answered, 10);
}

TEST(Recorder, ATapTestFindsTheReversedChannel) {
  test::RecorderBench b;
  b.play(0, 4, at_rest);
  ASSERT_EQ(b.recorder.tap(), "");
  b.play(4, 6, [](double t) { return t >= 5 && t < 5.02 ? -1.0 : at_rest(t); });
  // Both base channels felt it equally.
  EXPECT_NE(b.recorder.news().find("next to one sensor"), std::string::npos) << b.recorder.news();
  for (const double at_s : {6.0, 7.0}) {
    for (auto i = std::llround(100 * at_s); i < std::llround(100 * at_s) + 100; ++i)
      for (std::int32_t node = 0; node < 10; ++node) {
        const bool blow = i % 100 == 50 && node == (at_s < 7 ? 0 : 4);
        const double value =
            blow ? (node == 0 ? -2.0 : 2.0) : 1e-3 * std::sin(0.4 * static_cast<double>(i) + node);
        const auto bytes = drivers::encode_accel(
            {estimator::from_microseconds(10'000 * i), i, node, {value, value, NAN}});
        b.recorder.message("ACCEL", bytes.data(), bytes.size(), 10'000 * i);
      }
  }
  const auto results = b.recorder.channel_results();
  EXPECT_EQ(results[0].polarity, -1);
  EXPECT_NE(results[0].problem.find("reversed"), std::string::npos);
  EXPECT_EQ(results[4].polarity, 1);
  EXPECT_EQ(results[4].problem, "");
  EXPECT_EQ(results[1].polarity, 0);
}

}  // namespace recorder_test
}  // namespace framewatch::daemon
