#include "daemon/estimation/channel_events.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/events/event_words.h"
#include "tests/support/config_fixture.h"

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
  /// So many seconds of sensor time, in which the channel kDead is in this state.
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
      for (const event_t& e : events_.look(counters_, 1'000'000 * second_)) out.push_back(e);
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
  EXPECT_TRUE(seconds(60, State::silent).size() == 1);  // that clears only the silence below
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

}  // namespace channel_events_test
}  // namespace framewatch::daemon
