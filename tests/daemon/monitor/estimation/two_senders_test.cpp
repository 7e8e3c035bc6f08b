// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <framewatch/event_t.hpp>
#include <framewatch/status_t.hpp>

#include "daemon/config/config.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/tools/replay/replay_command.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace two_senders_test {

using drivers::LcmSender;
using drivers::SensorNodeSample;

constexpr double kSeconds = 25, kAttack_s = 12;
constexpr std::int32_t kNode = 2;     ///< channel F1-Y1
constexpr double kTwins_ratio = 0.8;  ///< share of the node's own values
constexpr LcmSender kSensors{0x7F000001, 40000}, kStranger{0x7F000001, 40001};

Config building(const char* more = "") {
  std::vector<ConfigProblem> problems;
  auto config = load_config(test::table_config(), problems);
  if (!config) throw std::runtime_error(problems.front().message);
  if (std::string(more) == "none") config->lcm.two_senders = drivers::TwoSenders::none;
  return *config;
}

const std::vector<drivers::LogEvent>& recorded() {
  static const std::vector<drivers::LogEvent> events = [] {
    const test::TemporaryDirectory directory;
    test::record_table_test(directory.path("rec.lcmlog"), kSeconds);
    drivers::LcmLogReader reader;
    if (!reader.open(directory.path("rec.lcmlog"))) throw std::runtime_error(reader.error());
    std::vector<drivers::LogEvent> out;
    drivers::LogEvent event;
    while (reader.next(event) == drivers::LogRead::event) out.push_back(event);
    return out;
  }();
  return events;
}

struct Played {
  explicit Played(const Config& of)
      : config(of),
        estimation(config, [this](std::int64_t, const std::string& channel,
                                  const std::vector<std::uint8_t>& bytes) {
          if (channel == "FRAMEWATCH_ESTIMATE") {
            estimate_bytes.push_back(bytes);
          }
          if (channel == "FRAMEWATCH_EVENT") events.push_back(*drivers::decoded<event_t>(bytes));
          if (channel == "FRAMEWATCH_STATUS") status = *drivers::decoded<status_t>(bytes);
        }) {}

  void give(const std::string& channel, const std::vector<std::uint8_t>& bytes,
            std::int64_t received_us, const LcmSender& sender) {
    estimation.message(channel, bytes.data(), bytes.size(), sender, received_us);
  }
  void sample(const SensorNodeSample& s, std::int64_t received_us, const LcmSender& sender) {
    give("ACCEL", drivers::encode_accel(s), received_us, sender);
  }
  std::vector<std::string> kinds() const {
    std::vector<std::string> out;
    for (const event_t& e : events)
      if (e.state == event_state::raised) out.push_back(e.kind + " " + e.place);
    return out;
  }
  /// Returns true if `framewatch status` would find no problem.
  bool well() const {
    const auto& raised = estimation.raised().all();
    return std::none_of(raised.begin(), raised.end(),
                        [](const event_t& e) { return e.severity >= severity::warning; });
  }

  const Config config;
  std::vector<std::vector<std::uint8_t>> estimate_bytes;
  std::vector<event_t> events;
  status_t status{};
  Estimation estimation;
};

/// Called before each message of the log.
using Attack = std::function<void(Played&, const drivers::LogEvent&, double time_s)>;

void play(Played& run, const LcmSender& sender, const Attack& attack = {}) {
  const std::int64_t first_us = recorded().front().timestamp_us;
  for (const drivers::LogEvent& event : recorded()) {
    const double time_s = 1e-6 * static_cast<double>(event.timestamp_us - first_us);
    if (attack) attack(run, event, time_s);
    run.give(event.channel, event.data, event.timestamp_us + 1, sender);
  }
  run.estimation.finish();
}

const Played& undisturbed() {
  static Played* const run = [] {
    auto* out = new Played(building());
    play(*out, {});
    return out;
  }();
  return *run;
}

/// Sends a message of the node at every instant after kAttack_s: the real one, changed by `change`.
Attack twin(const LcmSender& sender, const std::function<void(SensorNodeSample&)>& change) {
  return [=](Played& run, const drivers::LogEvent& event, double time_s) {
    const auto sample = drivers::decode_accel(event.data.data(), event.data.size());
    if (time_s < kAttack_s || !sample || sample->node != kNode) return;
    SensorNodeSample evil = *sample;
    for (double& a : evil.accel_abs_mps2) a *= kTwins_ratio;
    change(evil);
    run.sample(evil, event.timestamp_us, sender);
  };
}

using Kinds = std::vector<std::string>;

TEST(TwoSenders, AStrayChannelTableRaisesAnEventAndChangesNoEstimate) {
  Played run(building());
  bool sent = false;
  play(run, kSensors, [&](Played& r, const drivers::LogEvent& event, double time_s) {
    if (time_s < kAttack_s || sent) return;
    sent = true;
    const auto table =
        drivers::AccelMessages({"F1-Y1", "F1-Y2"}, {{"ACCEL", 3, 0}, {"ACCEL", 2, 0}}, 100)
            .tables(event.timestamp_us)
            .front();
    r.give(table.channel, table.bytes, event.timestamp_us, kStranger);
  });
  EXPECT_TRUE(run.estimate_bytes == undisturbed().estimate_bytes);
  EXPECT_EQ(run.kinds(), (Kinds{"channel_table F1-Y1", "channel_table F1-Y2"}));
  EXPECT_FALSE(run.well());
  EXPECT_EQ(run.events[0].message,
            "a channel table says that F1-Y1 is node 3 x of ACCEL, the configuration says that "
            "F1-Y1 is node 2 x of ACCEL: the configuration holds");
}

TEST(TwoSenders, EscapesNamesOfATable) {
  Played run(building());
  const auto table =
      drivers::AccelMessages({"x\x1b[2J\n<0>well"}, {{"ACCEL", 2, 0}}, 100).tables(0).front();
  run.give(table.channel, table.bytes, 1, {});
  ASSERT_EQ(run.events.size(), 1u);
  EXPECT_NE(run.events[0].message.find("calls node 2 x of ACCEL \"x?[2J?<0>well\""),
            std::string::npos)
      << run.events[0].message;
}

TEST(TwoSenders, ATwinFromAnotherAddressRaisesAnEventAndChangesNoEstimate) {
  Played run(building());
  play(run, kSensors, twin(kStranger, [](SensorNodeSample&) {}));
  EXPECT_TRUE(run.estimate_bytes == undisturbed().estimate_bytes);
  EXPECT_EQ(run.kinds(), Kinds{"two_senders F1-Y1"});
  EXPECT_EQ(run.events[0].severity, severity::alarm);
  EXPECT_EQ(run.events[0].message,
            "127.0.0.1:40000 and 127.0.0.1:40001 send under node 2 of ACCEL: only the samples of "
            "the first are used");
  EXPECT_FALSE(run.well());
  EXPECT_NEAR(static_cast<double>(run.status.rejected[2]), 100 * (kSeconds - kAttack_s), 1);
}

TEST(TwoSenders, StopsBothTwinsIfSoConfigured) {
  Played run(building("none"));
  play(run, kSensors, twin(kStranger, [](SensorNodeSample&) {}));
  EXPECT_NEAR(static_cast<double>(run.status.received[2]), 100 * kAttack_s, 2);
  EXPECT_EQ(run.kinds().front(), "two_senders F1-Y1");
}

TEST(TwoSenders, DetectsATwinWithoutAnAddressByItsNumbers) {
  const std::map<std::string, std::function<void(SensorNodeSample&)>> twins = {
      {"far numbers", [](SensorNodeSample& s) { s.sequence += 5'000'000; }},
      {"another phase",
       [](SensorNodeSample& s) {
         s.sequence += 700;
         s.time += std::chrono::milliseconds(5);
       }},
      {"behind", [](SensorNodeSample& s) { s.sequence -= 300; }},
  };
  for (const auto& [name, change] : twins) {
    Played run(building());
    play(run, {}, twin({}, change));
    EXPECT_TRUE(run.estimate_bytes == undisturbed().estimate_bytes) << name;
    const Kinds kinds = run.kinds();
    EXPECT_TRUE(std::count(kinds.begin(), kinds.end(), "two_senders F1-Y1")) << name;
    EXPECT_LE(kinds.size(), 2u) << name;
    EXPECT_FALSE(run.well()) << name;
    EXPECT_EQ(run.status.lost[2], 0) << name;
  }
}

TEST(TwoSenders, AnIndistinguishableTwinStopsTheNode) {
  Played run(building());
  play(run, {}, twin({}, [](SensorNodeSample&) {}));
  EXPECT_NEAR(static_cast<double>(run.status.received[2]), 100 * kAttack_s, 5);
  EXPECT_GT(run.status.rejected[2], 2 * 100 * (kSeconds - kAttack_s) - 10);
  EXPECT_EQ(run.kinds().front(), "two_senders F1-Y1");
  EXPECT_FALSE(run.well());
}

TEST(TwoSenders, OneMessageCannotSetTheLossCounter) {
  for (const std::int64_t far : {1'000'000LL, 9'999'999LL, 1LL << 62, -(1LL << 62)}) {
    Played run(building());
    bool sent = false;
    play(run, {}, [&](Played& r, const drivers::LogEvent& event, double time_s) {
      const auto sample = drivers::decode_accel(event.data.data(), event.data.size());
      if (time_s < kAttack_s || sent || !sample || sample->node != kNode) return;
      sent = true;
      r.sample({sample->time, sample->sequence + far, kNode, {1, 1, 1}}, event.timestamp_us, {});
    });
    EXPECT_EQ(run.status.lost[2], 0) << far;
    EXPECT_GE(run.kinds().size(), 1u) << far;
    EXPECT_TRUE(run.estimate_bytes == undisturbed().estimate_bytes) << far;
  }
}

TEST(TwoSenders, RaisedEventsSurviveARestartAndAreCleared) {
  const Config config = building();
  Played run(config);
  const auto at = [](std::int64_t i) { return 10'000 * (i + 1); };
  const auto send = [&](Played& to, std::int64_t i, const LcmSender& sender) {
    to.sample({estimator::from_microseconds(at(i)), i, kNode, {0.1, 0, 0}}, at(i), sender);
  };
  for (std::int64_t i = 0; i < 500; ++i) {
    send(run, i, kSensors);
    if (i > 100) send(run, i, kStranger);
  }
  ASSERT_EQ(run.events.size(), 1u);
  Played after(config);
  ASSERT_EQ(after.estimation.load(run.estimation.save()), "");
  EXPECT_FALSE(after.well());
  for (std::int64_t i = 500; i < 5000; ++i) send(after, i, kSensors);
  std::erase_if(after.events, [](const event_t& e) { return e.kind == "channel_silent"; });
  ASSERT_EQ(after.events.size(),
            1u);  // the events of the other nodes, which send nothing, come on top
  EXPECT_EQ(after.events[0].state, event_state::cleared);
  EXPECT_EQ(after.events[0].id, run.events[0].id);
  EXPECT_EQ(after.events[0].since_us, run.events[0].since_us);
  const auto& raised = after.estimation.raised().all();
  EXPECT_TRUE(std::none_of(raised.begin(), raised.end(),
                           [](const event_t& e) { return e.kind == "two_senders"; }));
}

TEST(TwoSenders, ReplayRefusesALogWhoseTableContradictsTheConfiguration) {
  const test::TemporaryDirectory directory;
  const std::string log = directory.path("rec.lcmlog");
  drivers::LcmLogWriter writer;
  ASSERT_TRUE(writer.open(log));
  const auto table = drivers::AccelMessages({"F1-Y1"}, {{"ACCEL", 3, 0}}, 100).tables(0).front();
  for (std::size_t i = 0; i < recorded().size(); ++i) {
    const drivers::LogEvent& event = recorded()[i];
    const auto write = [&](const std::string& channel, const std::vector<std::uint8_t>& bytes) {
      ASSERT_TRUE(writer.write(event.timestamp_us, channel, bytes.data(), bytes.size()));
    };
    if (i == recorded().size() / 2) write(table.channel, table.bytes);
    write(event.channel, event.data);
  }
  ASSERT_TRUE(writer.close());
  ReplayArguments arguments;
  arguments.config = test::table_config();
  arguments.inputs = {log};
  arguments.out = directory.path("est.lcmlog");
  arguments.quiet = true;
  EXPECT_EQ(replay(arguments), 2);
  arguments.salvage = true;
  EXPECT_EQ(replay(arguments), 0);
}

}  // namespace two_senders_test
}  // namespace framewatch::daemon
