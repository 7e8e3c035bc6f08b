// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimation/input_events.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <framewatch/accel_t.hpp>
#include <framewatch/event_t.hpp>

#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/live/run_command.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/can_traffic.h"
#include "tests/support/config_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace can_events_test {

using drivers::CanFrame;

struct Heard {
  explicit Heard(const Config& config)
      : estimation(config, [this](std::int64_t, const std::string& channel,
                                  const std::vector<std::uint8_t>& bytes) {
          if (!channel.ends_with("EVENT")) return;
          const auto event = drivers::decoded<event_t>(bytes);
          ASSERT_TRUE(event);
          events.push_back(*event);
        }) {}
  std::vector<event_t> events;
  Estimation estimation;
};

CanFrame frame(std::uint32_t id, std::vector<std::uint8_t> data, std::int64_t stamp_us) {
  CanFrame f;
  f.id = id;
  f.length = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), f.data.begin());
  f.stamp_us = stamp_us;
  return f;
}

TEST(CanEvents, BusOffIsRaisedAndClearedByTheNextFrame) {
  const Config config = test::can_example("tower");
  Heard heard(config);
  CanFrame off = frame(0x40, {0, 0, 0, 0, 0, 0, 0, 0}, 1000);
  off.error = true;
  heard.estimation.frame(0, off);
  heard.estimation.frame(0, off);
  ASSERT_EQ(heard.events.size(), 1u);
  heard.estimation.frame(0, frame(0x80, {1}, 5000));
  heard.estimation.frame(0, frame(0x80, {2}, 15000));
  ASSERT_EQ(heard.events.size(), 2u);
  const event_t &raised = heard.events[0], &cleared = heard.events[1];
  EXPECT_EQ(raised.kind, "bus_off");
  EXPECT_EQ(raised.place, "can0");
  EXPECT_EQ(raised.state, 1);
  EXPECT_EQ(raised.time_us, 1000);
  EXPECT_EQ(cleared.state, 0);
  EXPECT_EQ(cleared.since_us, 1000);
  EXPECT_EQ(cleared.time_us, 5000);
  EXPECT_EQ(cleared.id, raised.id);
}

TEST(CanEvents, EmergenciesAreRaisedChangedAndCleared) {
  const Config config = test::can_example("tower");
  Heard heard(config);
  const auto emergency = [&](std::uint8_t low, std::uint8_t high, std::int64_t stamp_us) {
    heard.estimation.frame(0, frame(0x083, {low, high, 0, 0, 0, 0, 0, 0}, stamp_us));
  };
  emergency(0, 0, 500);  // nothing to clear
  emergency(0x10, 0x81, 1000);
  emergency(0x10, 0x81, 2000);
  emergency(0x20, 0x81, 3000);
  emergency(0, 0, 4000);
  ASSERT_EQ(heard.events.size(), 3u);
  const int states[] = {1, 2, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(heard.events[i].kind, "emergency");
    EXPECT_EQ(heard.events[i].place, config.can.nodes[2].name);
    EXPECT_EQ(heard.events[i].state, states[i]);
    EXPECT_EQ(heard.events[i].since_us, 1000);
    EXPECT_EQ(heard.events[i].id, heard.events[0].id);
  }
  EXPECT_EQ(heard.events[0].value, 0x8110);
  EXPECT_NE(heard.events[0].message.find("8110h"), std::string::npos);
}

TEST(CanEvents, EveryBootUpIsReportedAndLeavesNothingOpen) {
  const Config config = test::can_example("tower");
  Heard heard(config);
  heard.estimation.frame(0, frame(0x701, {0}, 1000));
  heard.estimation.frame(0, frame(0x701, {5}, 1500));  // a heartbeat
  heard.estimation.frame(0, frame(0x701, {0}, 2000));
  heard.estimation.frame(0, frame(0x77F, {0}, 2500));  // unknown node
  ASSERT_EQ(heard.events.size(), 2u);
  for (const event_t& event : heard.events) {
    EXPECT_EQ(event.kind, "boot_up");
    EXPECT_EQ(event.state, 0);
    EXPECT_EQ(event.severity, 0);
  }
}

TEST(CanEvents, AnInterfaceThatDisappearsIsReportedOnceUntilItReturns) {
  const Config config = test::can_example("bosch_mm510");
  Heard heard(config);
  for (const bool over : {true, false, false, true, true})
    heard.estimation.notice({drivers::CanNotice::Kind::interface_gone, 1, over, 0, 7});
  ASSERT_EQ(heard.events.size(), 2u);
  EXPECT_EQ(heard.events[0].state, 1);
  EXPECT_EQ(heard.events[0].place, config.can.buses[1].interface);
  EXPECT_EQ(heard.events[1].state, 0);
  EXPECT_NE(
      heard.events[0].id,
      CanEvents(config.can).of({drivers::CanNotice::Kind::interface_gone, 0, false, 0, 7})->id);
}

TEST(CanEvents, GoodTrafficRaisesNone) {
  for (const char* name : {"raw_int16", "xsens_mti600", "bosch_mm510", "fd_block", "tower"}) {
    const Config config = test::can_example(name);
    Heard heard(config);
    for (const drivers::BusFrame& f : test::can_traffic(config, 3000))
      heard.estimation.frame(f.bus, f.frame);
    EXPECT_TRUE(heard.events.empty()) << name << ": " << heard.events[0].message;
  }
}

TEST(CanEvents, ASecondNodeWithTheSameIdsIsReportedOnceUntilItIsGone) {
  for (const char* name : {"raw_int16", "tower"}) {
    const Config config = test::can_example(name);
    Heard heard(config);
    const std::uint32_t id = config.can.nodes[1].messages[0].id;
    const auto rate = static_cast<int>(config.pipeline.options.rate_hz);
    const std::int64_t begin_us = test::kTrafficStart_us + 5'000'000, end_us = begin_us + 8'000'000;
    for (const drivers::BusFrame& f : test::can_traffic(config, 60 * rate)) {
      heard.estimation.frame(f.bus, f.frame);
      if (f.frame.id != id || f.frame.stamp_us < begin_us || f.frame.stamp_us > end_us) continue;
      CanFrame twin = f.frame;
      twin.stamp_us += 50;
      twin.data[0] ^= 0x10;
      heard.estimation.frame(f.bus, twin);
    }
    ASSERT_EQ(heard.events.size(), 2u) << name;
    EXPECT_EQ(heard.events[0].kind, "duplicates") << name;
    EXPECT_EQ(heard.events[0].place, config.can.nodes[1].name);
    EXPECT_EQ(heard.events[0].severity, 1);
    EXPECT_GE(heard.events[0].value, 5);
    EXPECT_EQ(heard.events[1].state, 0);
    EXPECT_EQ(heard.events[1].id, heard.events[0].id);
  }
}

TEST(CanEvents, AMissingInterfaceIsReportedOnce) {
  Config config = test::can_example("tower");
  config.can.buses[0].interface = "nocan9";
  drivers::LcmProvider lcm("memq://");
  std::vector<event_t> events;
  const auto hear =
      +[](const lcm::ReceiveBuffer* buffer, const std::string&, std::vector<event_t>* heard) {
        const auto event = drivers::decoded<event_t>(
            {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
        if (event) heard->push_back(*event);
      };
  lcm.subscribeFunction("FRAMEWATCH_EVENT", hear, &events);
  LiveEstimation live(config, lcm);
  EXPECT_EQ(live.open_buses().size(), 1u);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(live.poll(1));
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, "interface_gone");
  EXPECT_EQ(events[0].place, "nocan9");
  EXPECT_EQ(events[0].state, 1);
}

}  // namespace can_events_test

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

TEST_F(ChannelEventsTest, NamesASilentChannelSinceWhen) {
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

TEST_F(ChannelEventsTest, NamesAChannelThatNeverSent) {
  const auto raised = seconds(10, State::silent);
  ASSERT_EQ(raised.size(), 1u);
  EXPECT_NE(raised[0].message.find("yet"), std::string::npos);
}

TEST_F(ChannelEventsTest, NamesAStuckChannelUntilItMovesAgain) {
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

TEST_F(ChannelEventsTest, IgnoresAShortSilence) {
  seconds(10, State::good);
  EXPECT_TRUE(seconds(ChannelEvents::kSilent_s - 1, State::silent).empty());
  EXPECT_TRUE(seconds(5, State::good).empty());
  EXPECT_TRUE(seconds(ChannelEvents::kStuck_s - 1, State::stuck).empty());
  EXPECT_TRUE(seconds(5, State::good).empty());
}

/// A shaken table; at half of the record node 3 falls silent and node 4 sticks.
TEST(ChannelEventsOfARecord, NameOnlyTheDeadAndTheStuckSensor) {
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
