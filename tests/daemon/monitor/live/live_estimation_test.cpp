// SPDX-License-Identifier: MIT
#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include <gtest/gtest.h>

#include <framewatch/event_t.hpp>
#include <framewatch/status_t.hpp>

#include "daemon/monitor/live/run_command.h"
#include "daemon/tools/replay/replay_command.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/support/child.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace live_estimation_test {

using drivers::LcmLogReader;
using drivers::LogEvent;
using drivers::LogRead;
using Payloads = std::vector<std::vector<std::uint8_t>>;

Config table() {
  std::vector<ConfigProblem> problems;
  auto config = load_config(test::table_config(), problems);
  if (!config) throw std::runtime_error(problems.front().message);
  return *config;
}

struct Collected {
  Payloads estimates, statuses;
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
    (channel.starts_with("FRAMEWATCH_ESTIMATE") ? estimates : statuses)
        .emplace_back(bytes, bytes + buffer->data_size);
  }
};

/// Plays a log through live LCM in this process.
Collected run_live(const Config& config, const std::string& log) {
  drivers::LcmProvider lcm("memq://");
  Collected collected;
  for (const char* channel : {"FRAMEWATCH_ESTIMATE.*", "FRAMEWATCH_STATUS"})
    lcm.subscribe(channel, &Collected::on_message, &collected)->setQueueCapacity(100000);
  LiveEstimation live(config, lcm);
  LcmLogReader reader;
  EXPECT_TRUE(reader.open(log));
  LogEvent event;
  while (reader.next(event) == LogRead::event) {
    lcm.publish(event.channel, event.data.data(), static_cast<unsigned>(event.data.size()));
    EXPECT_TRUE(live.poll(0));
  }
  while (lcm.handleTimeout(200) > 0) {
  }
  live.finish();
  while (lcm.handleTimeout(200) > 0) {
  }
  return collected;
}

TEST(LiveEstimation, GivesTheBytesOfAReplayInOnePass) {
  const test::TemporaryDirectory directory;
  test::record_table_test(directory.path("rec.lcmlog"), 8);
  const Config config = table();
  const Collected live = run_live(config, directory.path("rec.lcmlog"));
  ReplayArguments as_it_comes;
  as_it_comes.config = test::table_config();
  as_it_comes.inputs = {directory.path("rec.lcmlog")};
  as_it_comes.out = directory.path("est.lcmlog");
  as_it_comes.quiet = as_it_comes.one_pass = true;
  ASSERT_EQ(replay(as_it_comes), 0);
  Payloads replayed;
  LcmLogReader reader;
  ASSERT_TRUE(reader.open(directory.path("est.lcmlog")));
  LogEvent event;
  while (reader.next(event) == LogRead::event)
    if (event.channel.starts_with("FRAMEWATCH_ESTIMATE")) replayed.push_back(event.data);
  EXPECT_GT(replayed.size(), 200u);
  EXPECT_TRUE(live.estimates == replayed);
}

TEST(LiveEstimation, CountsBadInputAndContinues) {
  const Config config = table();
  drivers::LcmProvider lcm("memq://");
  LiveEstimation live(config, lcm);
  for (int i = 0; i < 100; ++i) {
    lcm.publish("ACCEL", "garbage", 7);
    lcm.publish("ACCEL_CHANNELS", "\xff\xff\xff\xff", 4);
    lcm.publish("ELSEWHERE", "x", 1);
  }
  while (live.estimation().intake().counters().messages < 200 && live.poll(100)) {
  }
  EXPECT_EQ(live.estimation().intake().counters().malformed, 200);
  EXPECT_GT(live.state().queue_high_water, 0);
  live.finish();
}

TEST(LiveEstimation, TheConfigurationOverridesAStrayChannelTable) {
  const Config config = table();
  drivers::LcmProvider lcm("memq://");
  LiveEstimation live(config, lcm);
  const auto send = [&](const drivers::Message& message) {
    lcm.publish(message.channel, message.bytes.data(), static_cast<unsigned>(message.bytes.size()));
    EXPECT_TRUE(live.poll(100));
  };
  const drivers::AccelMessages swapped({"F1-Y1", "F1-Y2"}, {{"ACCEL", 3, 0}, {"ACCEL", 2, 0}}, 100);
  for (int i = 0; i < 1000; ++i) send(swapped.tables(i).front());
  const std::vector<event_t> events = live.take_events();
  ASSERT_EQ(events.size(), 2u);
  for (const event_t& event : events) EXPECT_EQ(event.kind, "channel_table");
  EXPECT_EQ(live.estimation().raised().all().size(), 2u);
  const drivers::AxisBinding::NodeAxes* axes =
      live.estimation().intake().binding().axes_of("ACCEL", 2);
  ASSERT_NE(axes, nullptr);
  EXPECT_EQ(config.pipeline.axes[static_cast<std::size_t>((*axes)[0])].name, "F1-Y1");
}

TEST(SensorSeconds, TicksOnceASecondAndIgnoresAStrayClock) {
  SensorSeconds seconds;
  int ticks = 0;
  for (std::int64_t i = 0; i <= 1000; ++i) {
    ticks += seconds.passed(10'000 * i);
    ticks += seconds.passed(INT64_MAX - 5);  // a node with a broken clock
  }
  EXPECT_EQ(ticks, 11);
  EXPECT_EQ(seconds.newest_us(), 10'000'000);
}

TEST(SensorSeconds, FollowsAJumpOfAllClocks) {
  SensorSeconds seconds;
  EXPECT_TRUE(seconds.passed(1'000'000'000));
  int ticks = 0;
  for (std::int64_t i = 0; i < 2000; ++i) ticks += seconds.passed(10'000 * i);
  EXPECT_GE(ticks, 10);
  EXPECT_LT(seconds.newest_us(), 30'000'000);
}

TEST(Run, EstimatesOverMulticastAndStopsCleanly) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  std::string error;
  const auto lcm = drivers::open_lcm(table().lcm.url, {}, error);
  if (!lcm) GTEST_SKIP() << error;
  Collected collected;
  for (const char* channel : {"FRAMEWATCH_ESTIMATE.*", "FRAMEWATCH_STATUS"})
    lcm->subscribe(channel, &Collected::on_message, &collected)->setQueueCapacity(100000);

  for (const int signal : {SIGINT, SIGTERM}) {
    collected = {};
    test::Child daemon({FRAMEWATCH_PROGRAM, "run", test::table_config(), "--quiet"});
    test::Child table_test({FRAMEWATCH_PROGRAM, "simulate",
                            FRAMEWATCH_SOURCE_DIR "/configs/scenario_table_two_story.toml", "--lcm",
                            "--seconds", "7", "--speed", "2", "--quiet"});
    while (collected.estimates.size() < 20 && lcm->handleTimeout(20000) > 0) {
    }
    EXPECT_GE(collected.estimates.size(), 20u);
    EXPECT_EQ(daemon.stop(signal), 0);
    EXPECT_EQ(table_test.wait(), 0);
    while (lcm->handleTimeout(200) > 0) {
    }
    ASSERT_FALSE(collected.statuses.empty());
    framewatch::status_t status{};
    const auto& bytes = collected.statuses.back();
    ASSERT_GT(status.decode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
    EXPECT_GT(status.latency_s, 0);
    EXPECT_EQ(status.queue_dropped, 0);
  }
}

TEST(Run, RefusesABadConfigurationAndABadUrl) {
  EXPECT_EQ(run({"/nonexistent.toml", "", true}), 2);
  EXPECT_EQ(run({test::table_config(), "bogus://", true}), 2);
}

}  // namespace live_estimation_test
}  // namespace framewatch::daemon
