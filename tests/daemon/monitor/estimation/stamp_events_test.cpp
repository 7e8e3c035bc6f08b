// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimation/stamp_events.h"

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <framewatch/accel_t.hpp>
#include <framewatch/event_t.hpp>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/base/usual_time.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/events/event_messages.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/config_fixture.h"
#include "tests/support/recorded_table_test.h"

namespace framewatch::daemon {
namespace stamp_events_test {

constexpr std::int64_t kStart_us = 1'700'000'000 * kSecond_us, kStep_us = 10'000;
constexpr std::int64_t kYear_us = 31'557'600 * kSecond_us;
constexpr int kOdd = 2;  // node of F1-Y1 alone
constexpr int kNodes = 6;

struct Sent {
  std::int64_t time_us, sequence;
  bool comes = true;
  bool twice = false;  ///< another one follows half a step later
};

/// A network of six nodes with one channel each, at 100 Hz.
class Network {
 public:
  Network()
      : config_(test::good(config_text())),
        estimation_(config_, [this](std::int64_t, const std::string& channel,
                                    const std::vector<std::uint8_t>& bytes) {
          if (channel.ends_with("EVENT")) events_.push_back(*drivers::decoded<event_t>(bytes));
        }) {}

  /// Sends `seconds` of messages. `change` changes the stamp and number of each.
  void run(int seconds, const std::function<void(int node, std::int64_t instant, Sent&)>& change) {
    for (std::int64_t end = instant_ + 100 * seconds; instant_ < end; ++instant_)
      for (int node = 0; node < kNodes; ++node) {
        Sent sent{kStart_us + kStep_us * instant_, instant_};
        change(node, instant_, sent);
        if (!sent.comes) continue;
        send(node, sent.time_us, sent.sequence);
        if (sent.twice) send(node, sent.time_us + kStep_us / 2, sent.sequence + 1);
      }
  }
  void run(int seconds) {
    run(seconds, [](int, std::int64_t, Sent&) {});
  }
  const std::vector<event_t>& events() const { return events_; }
  std::vector<event_t> take() { return std::exchange(events_, {}); }

 private:
  void send(int node, std::int64_t time_us, std::int64_t sequence) {
    accel_t m{};
    m.time_us = time_us;
    m.sequence = sequence;
    m.node = node;
    m.accel_abs_mps2[0] = std::sin(0.1 * static_cast<double>(instant_) + node);
    const std::vector<std::uint8_t> bytes = drivers::encoded(m);
    estimation_.message("ACCEL", bytes.data(), bytes.size(), {}, kStart_us + kStep_us * instant_);
  }
  static std::string config_text() {
    std::string text = test::replaced(test::kGoodConfig,
                                      "source = { lcm = \"ACCEL\", node = 2, axis = \"x\" }\n", "");
    int node = 0;
    for (const char* name : {"base-x", "base-y", "F1-Y1", "F1-Y2", "F1-X1", "F1-X2"}) {
      const std::string line = std::string("name = \"") + name + "\"\n";
      text = test::replaced(text, line,
                            line + "source = { lcm = \"ACCEL\", node = " + std::to_string(node++) +
                                ", axis = \"x\" }\n");
    }
    return text;
  }

  Config config_;
  std::vector<event_t> events_;
  Estimation estimation_;
  std::int64_t instant_ = 0;
};

/// Expects one event of this kind and state, at F1-Y1, and returns it.
event_t only(const std::vector<event_t>& events, const std::string& kind, int state) {
  EXPECT_EQ(events.size(), 1u);
  for (const event_t& e : events) {
    EXPECT_EQ(e.kind, kind) << e.message;
    EXPECT_EQ(e.state, state) << e.message;
    EXPECT_EQ(e.place, "F1-Y1") << e.message;
  }
  return events.empty() ? event_t{} : events.front();
}

TEST(ChannelRate, IsWellAtTheConfiguredRate) {
  Network network;
  network.run(60);
  EXPECT_TRUE(network.events().empty());
}

/// The numbers of the node go on, so that nothing looks lost.
TEST(ChannelRate, NamesANodeAtHalfItsRate) {
  Network network;
  network.run(20);
  network.run(20, [](int node, std::int64_t instant, Sent& sent) {
    sent.comes = node != kOdd || instant % 2 == 0;
    if (node == kOdd) sent.sequence = 2000 + (instant - 2000) / 2;
  });
  const event_t raised = only(network.take(), "channel_rate", event_state::raised);
  EXPECT_NEAR(raised.value, 50, 1);
  EXPECT_EQ(raised.unit, "Hz");
  EXPECT_EQ(raised.severity, severity::warning);
  EXPECT_NE(raised.message.find("F1-Y1 sends 50 samples a second without a missing number, but "
                                "rate_hz is 100"),
            std::string::npos)
      << raised.message;
}

/// One of 33 instants is missing, without a missing number.
TEST(ChannelRate, NamesANodeThatLeavesOutInstantsAndClearsTheEvent) {
  Network network;
  network.run(20);
  network.run(20, [](int node, std::int64_t instant, Sent& sent) {
    sent.comes = node != kOdd || (instant - 2000) % 33 != 0;
    if (node == kOdd) sent.sequence = 2000 + (instant - 2000) * 32 / 33;
  });
  const event_t raised = only(network.take(), "channel_rate", event_state::raised);
  EXPECT_NEAR(raised.value, 97, 0.5);
  network.run(20, [](int node, std::int64_t instant, Sent& sent) {
    if (node == kOdd) sent.sequence = 2000 + 2000 * 32 / 33 + (instant - 4000);
  });
  EXPECT_EQ(only(network.take(), "channel_rate", event_state::cleared).id, raised.id);
}

TEST(ChannelRate, LeavesLossesToTheEventOfLosses) {
  Network network;
  network.run(20);
  network.run(30, [](int node, std::int64_t instant, Sent& sent) {
    sent.comes = node != kOdd || instant % 4 != 0;
  });
  only(network.take(), "losses", event_state::raised);
}

TEST(ChannelRate, NamesANodeAtDoubleItsRate) {
  Network network;
  network.run(20);
  network.run(20, [](int node, std::int64_t instant, Sent& sent) {
    if (node != kOdd) return;
    sent.twice = true;
    sent.sequence = 2000 + 2 * (instant - 2000);
  });
  EXPECT_NEAR(only(network.take(), "channel_rate", event_state::raised).value, 200, 1);
}

TEST(ChannelRate, NamesANodeAtAnOddRate) {
  constexpr int kOdd_hz = 97;
  Network network;
  network.run(20);
  std::int64_t before = 0;
  network.run(20, [&](int node, std::int64_t instant, Sent& sent) {
    if (node != kOdd) return;
    sent.sequence = 2000 + before;
    sent.time_us = kStart_us + 2000 * kStep_us + before * kSecond_us / kOdd_hz;
    sent.comes = sent.time_us <= kStart_us + kStep_us * instant;
    before += sent.comes;
  });
  EXPECT_NEAR(only(network.take(), "channel_rate", event_state::raised).value, kOdd_hz, 0.5);
}

/// Every node falls back to half its rate.
TEST(ChannelRate, NamesEveryChannelOfASlowNetwork) {
  Network network;
  network.run(20);
  network.run(20, [](int, std::int64_t instant, Sent& sent) {
    sent.comes = instant % 2 == 0;
    sent.sequence = 2000 + (instant - 2000) / 2;
  });
  const std::vector<event_t> events = network.take();
  ASSERT_EQ(events.size(), 6u);
  for (const event_t& e : events) EXPECT_EQ(e.kind, "channel_rate") << e.message;
}

TEST(ChannelClock, NamesOneNodeApartFromTheOthers) {
  for (const std::int64_t offset_us :
       {10 * kYear_us, -10 * kYear_us, 1024 * 7 * kDay_us, 3 * kSecond_us, -2 * kSecond_us}) {
    Network network;
    network.run(20);
    network.run(10, [&](int node, std::int64_t, Sent& sent) {
      sent.time_us += node == kOdd ? offset_us : 0;
    });
    std::vector<event_t> events = network.take();
    std::erase_if(events, [](const event_t& e) { return e.kind != "channel_clock"; });
    const event_t raised = only(events, "channel_clock", event_state::raised);
    EXPECT_NEAR(raised.value, 1e-6 * static_cast<double>(offset_us), 0.1);
    network.run(10);
    events = network.take();
    std::erase_if(events, [](const event_t& e) { return e.kind != "channel_clock"; });
    EXPECT_EQ(only(events, "channel_clock", event_state::cleared).id, raised.id);
  }
}

TEST(ClockSteps, OfAllClocksAreRaisedUntilTheyStepBack) {
  for (const std::int64_t step_us : {-1024 * 7 * kDay_us, 10 * kYear_us, -3600 * kSecond_us}) {
    Network network;
    network.run(20);
    network.run(20, [&](int, std::int64_t, Sent& sent) { sent.time_us += step_us; });
    std::vector<event_t> events = network.take();
    ASSERT_EQ(events.size(), 1u) << events.back().message;
    EXPECT_EQ(events[0].kind, "clock_step");
    EXPECT_EQ(events[0].state, event_state::raised);
    EXPECT_EQ(events[0].severity, severity::warning);
    EXPECT_NEAR(events[0].value, 1e-6 * static_cast<double>(step_us), 10);
    network.run(20);
    events = network.take();
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].kind, "clock_step");
    EXPECT_EQ(events[0].state, event_state::cleared);
  }
}

TEST(ClockSteps, AreNotPausesInWhichTimePasses) {
  ClockEvents events;
  std::int64_t time_us = kStart_us, arrival_us = 5 * kStart_us;
  EXPECT_FALSE(events.update(time_us, arrival_us));
  EXPECT_FALSE(events.update(time_us += 3600 * kSecond_us, arrival_us += 3600 * kSecond_us));
  EXPECT_FALSE(events.update(time_us += kSecond_us, arrival_us += 3600 * kSecond_us))
      << "a step of the receiver's clock";
  EXPECT_FALSE(events.update(time_us += 3600 * kSecond_us, 0)) << "no arrival is known";
  EXPECT_TRUE(events.update(time_us -= 3600 * kSecond_us, 0));
}

TEST(UsualTime, IgnoresOneWrongClock) {
  EXPECT_EQ(usual_time_us({0, 7, 5, kYear_us, 6}, 0), 7);
  EXPECT_EQ(usual_time_us({5, kYear_us, 6}, 0), 6);
  EXPECT_EQ(usual_time_us({0, 0}, 0), 0);
}

}  // namespace stamp_events_test
}  // namespace framewatch::daemon
