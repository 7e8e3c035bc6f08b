#include "daemon/monitor/estimation/input_events.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <framewatch/accel_t.hpp>

#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/events/event_messages.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/config_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace channel_events_test {

constexpr double kLateness_s = 0.5;
constexpr std::size_t kDead = 3;

class ChannelEventsTest : public ::testing::Test {
 protected:
  ChannelEventsTest()
      : config_(test::good(test::kGoodConfig)),
        events_(config_.pipeline.axes, kLateness_s),
        counters_(config_.pipeline.axes.size()) {}

  enum class State { good, silent, stuck };
  /// Feeds `count` seconds of sensor time in which the channel kDead has this state.
  std::vector<event_t> seconds(int count, State state, bool others = true) {
    std::vector<event_t> out;
    for (int i = 0; i < count; ++i) {
      for (std::size_t a = 0; a < counters_.size(); ++a) {
        const State now = a == kDead ? state : State::good;
        if (now == State::silent || (a != kDead && !others)) continue;
        counters_[a].received += 100;
        counters_[a].stuck += now == State::stuck ? 100 : 0;
        const double value = now == State::stuck ? 1 : static_cast<double>(second_ % 3);
        events_.sample({{}, static_cast<int>(a), value});
      }
      second_ += 1;
      for (const event_t& e : events_.update(counters_, 1'000'000 * second_)) out.push_back(e);
    }
    return out;
  }

  Config config_;
  ChannelEvents events_;
  std::vector<estimator::AxisCounters> counters_;
  std::int64_t second_ = 1'700'000'000;
};

TEST_F(ChannelEventsTest, ASilentChannelIsNamedWithTheTimeSinceWhen) {
  EXPECT_TRUE(seconds(20, State::good).empty());
  const std::int64_t last_us = 1'000'000 * second_;
  const auto raised = seconds(20, State::silent);
  ASSERT_EQ(raised.size(), 1u);
  EXPECT_EQ(raised[0].kind, "channel_silent");
  EXPECT_EQ(raised[0].place, "F1-Y2");
  EXPECT_EQ(raised[0].state, event_state::raised);
  EXPECT_EQ(raised[0].severity, severity::warning);
  EXPECT_EQ(raised[0].since_us, last_us);
  EXPECT_LE(raised[0].time_us - last_us, 1'000'000 * (ChannelEvents::kSilent_s + 1));
  const auto cleared = seconds(3, State::good);
  ASSERT_EQ(cleared.size(), 1u);
  EXPECT_EQ(cleared[0].id, raised[0].id);
  EXPECT_EQ(cleared[0].state, event_state::cleared);
}

TEST_F(ChannelEventsTest, OneThatNeverSpokeIsSilentToo) {
  const auto raised = seconds(10, State::silent);
  ASSERT_EQ(raised.size(), 1u);
  EXPECT_NE(raised[0].message.find("yet"), std::string::npos);
}

TEST_F(ChannelEventsTest, AStuckChannelIsNamedUntilItMovesAgain) {
  EXPECT_TRUE(seconds(10, State::good).empty());
  const auto raised = seconds(10, State::stuck);
  ASSERT_EQ(raised.size(), 1u);
  EXPECT_EQ(raised[0].kind, "channel_stuck");
  EXPECT_EQ(raised[0].place, "F1-Y2");
  EXPECT_TRUE(seconds(60, State::silent).size() == 1);  // clears only the silence below
  const auto after = seconds(10, State::good);
  ASSERT_EQ(after.size(), 2u);
  EXPECT_EQ(after.back().kind, "channel_stuck");
  EXPECT_EQ(after.back().state, event_state::cleared);
}

TEST_F(ChannelEventsTest, AMomentIsNothing) {
  seconds(10, State::good);
  EXPECT_TRUE(seconds(ChannelEvents::kSilent_s - 1, State::silent).empty());
  EXPECT_TRUE(seconds(5, State::good).empty());
  EXPECT_TRUE(seconds(ChannelEvents::kStuck_s - 1, State::stuck).empty());
  EXPECT_TRUE(seconds(5, State::good).empty());
}

/// A shaken table; at half of the record node 3 falls silent and node 4 sticks.
TEST(ChannelEventsOfARecord, ADeadAndAStuckSensorAreNamedAndNoOther) {
  constexpr double kSeconds = 30, kDies_s = 12;
  constexpr int kSilent = 3, kStuck = 4;
  const test::TemporaryDirectory directory;
  test::record_table_test(directory.path("rec.lcmlog"), kSeconds);
  std::vector<ConfigProblem> problems;
  const auto config = load_config(test::table_config(), problems);
  ASSERT_TRUE(config);
  std::vector<event_t> events;
  Estimation estimation(*config, [&](std::int64_t, const std::string& channel,
                                     const std::vector<std::uint8_t>& bytes) {
    if (channel.ends_with("EVENT")) events.push_back(*drivers::decoded<event_t>(bytes));
  });
  drivers::LcmLogReader reader;
  ASSERT_TRUE(reader.open(directory.path("rec.lcmlog")));
  std::int64_t first_us = 0;
  std::vector<std::uint8_t> bytes;
  for (drivers::LogEvent e; reader.next(e) == drivers::LogRead::event;) {
    auto m = drivers::decoded<accel_t>(e.data);
    if (m && first_us == 0) first_us = m->time_us;
    const bool dead = m && 1e-6 * static_cast<double>(m->time_us - first_us) > kDies_s;
    if (dead && m->node == kSilent) continue;
    if (dead && m->node == kStuck) {
      for (double& value : m->accel_abs_mps2)
        if (std::isfinite(value)) value = 0.25;
      drivers::encode_into(bytes, *m);
      e.data.assign(bytes.begin(), bytes.end());
    }
    estimation.message(e.channel, e.data.data(), e.data.size());
  }
  estimation.finish();
  ASSERT_EQ(events.size(), 2u);
  for (const event_t& e : events) {
    EXPECT_EQ(e.kind, e.place == "F1-Y2" ? "channel_silent" : "channel_stuck");
    EXPECT_EQ(e.place, e.kind == "channel_stuck" ? "F1-X1" : "F1-Y2");
    EXPECT_NEAR(1e-6 * static_cast<double>(e.since_us - first_us), kDies_s, 2) << e.kind;
  }
}

}  // namespace channel_events_test
}  // namespace framewatch::daemon
