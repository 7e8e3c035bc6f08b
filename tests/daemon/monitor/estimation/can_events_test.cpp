#include <framewatch/event_t.hpp>

#include "daemon/monitor/estimation/input_events.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/live/run_command.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/can_traffic.h"

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

TEST(CanEvents, EveryBootUpIsToldAndLeavesNothingOpen) {
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

TEST(CanEvents, AnInterfaceThatGoesIsToldOnceAndWhenItIsBack) {
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

TEST(CanEvents, GoodTrafficGivesNone) {
  for (const char* name : {"raw_int16", "xsens_mti600", "bosch_mm510", "fd_block", "tower"}) {
    const Config config = test::can_example(name);
    Heard heard(config);
    for (const drivers::BusFrame& f : test::can_traffic(config, 3000))
      heard.estimation.frame(f.bus, f.frame);
    EXPECT_TRUE(heard.events.empty()) << name << ": " << heard.events[0].message;
  }
}

TEST(CanEvents, ASecondNodeWithTheSameIdsIsToldOnceAndWhenItIsGone) {
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

TEST(CanEvents, ALiveInterfaceThatIsNotThereIsToldOnce) {
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
}  // namespace framewatch::daemon
