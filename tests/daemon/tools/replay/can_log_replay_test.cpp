// SPDX-License-Identifier: MIT
// A CAN log gives the same samples in every format, whatever name the interface has.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/config/config.h"
#include "daemon/tools/replay/replay_command.h"
#include "daemon/tools/replay/stored_samples.h"
#include "drivers/can/can_log.h"
#include "drivers/lcm/accel_intake.h"
#include "tests/daemon/tools/replay/replay_fixture.h"
#include "tests/support/config_fixture.h"
#include "tests/support/temporary.h"
#include "tests/support/vector_logs.h"

namespace framewatch::daemon {
namespace can_log_replay_test {

using drivers::CanFrame;
using test::BlfWriter;

constexpr int kInstants = 300;
constexpr std::int64_t kStart_us = 1'795'822'205'250'000;  // that of BlfWriter

const std::string kDbc = R"(BU_: Node
BO_ 384 Accel: 8 Node
 SG_ X : 0|16@1- (0.001,0) [0|0] "m/s^2" Node
 SG_ Count : 48|16@1+ (1,0) [0|65535] "" Node
)";

const std::string kConfig = R"([structure]
stories = 1
frames_x = ["y1"]
story_height_m = [3.0]
node_mass_kg = 1000.0
[estimator]
rate_hz = 100.0
[[can]]
interface = "can0"
dbc = ["n.dbc"]
[[can_node]]
name = "ground"
messages = ["Accel"]
id_offset = 1
counter = "Accel.Count"
[[can_node]]
name = "roof"
messages = ["Accel"]
id_offset = 2
counter = "Accel.Count"
[[channel]]
name = "base"
story = 0
direction = "x"
source = { can = "can0", dbc_signal = "Accel.X", can_node = "ground" }
[[channel]]
name = "roof"
story = 1
frame = "y1"
source = { can = "can0", dbc_signal = "Accel.X", can_node = "roof" }
)";

/// 0.1 m/s^2 on the base, -0.5 on the roof, and a counter.
CanFrame frame_at(int instant, bool roof) {
  CanFrame frame;
  frame.id = roof ? 0x182 : 0x181;
  frame.length = 8;
  const std::uint16_t raw = roof ? 0xFE0C : 0x0064;
  frame.data[0] = static_cast<std::uint8_t>(raw);
  frame.data[1] = static_cast<std::uint8_t>(raw >> 8);
  frame.data[6] = static_cast<std::uint8_t>(instant);
  frame.data[7] = static_cast<std::uint8_t>(instant >> 8);
  frame.stamp_us = kStart_us + 10'000 * std::int64_t{instant} + (roof ? 600 : 300);
  return frame;
}

class CanLogReplay : public testing::Test {
 protected:
  CanLogReplay() {
    test::write_file(directory_.path("n.dbc"), kDbc);
    test::write_file(directory_.path("c.toml"), kConfig);
    std::string candump, nanoseconds, objects, screen;
    std::string asc = "date Fri Nov 27 11:30:05.250 pm 2026\nbase hex  timestamps absolute\n";
    for (int i = 0; i < kInstants; ++i)
      for (const bool roof : {false, true}) {
        const CanFrame frame = frame_at(i, roof);
        const std::int64_t after_us = frame.stamp_us - kStart_us;
        const std::string line = drivers::candump_line(frame, "can0");
        candump += line + "\n";
        nanoseconds += line.substr(0, 18) + "999" + line.substr(18) + "\n";
        asc += test::asc_line(frame, 1,
                              fmt::format("{}.{:06}", after_us / 1'000'000, after_us % 1'000'000));
        objects += BlfWriter::message(frame, 1, static_cast<std::uint64_t>(after_us) * 1000);
        screen += fmt::format(" {}  can0  {:X}   [8]  00 00\n", line.substr(0, 19), frame.id);
      }
    test::write_file(directory_.path("candump.log"), candump);
    test::write_file(directory_.path("nanoseconds.log"), nanoseconds);
    test::write_file(directory_.path("screen.log"), screen);
    test::write_file(directory_.path("vector.asc"), asc);
    test::write_file(directory_.path("vector.blf"),
                     BlfWriter::file(BlfWriter::container(objects.substr(0, 10'000)) +
                                     BlfWriter::container(objects.substr(10'000))));
  }

  test::ReplayOutcome replayed(const std::string& name) {
    return test::replay_of({directory_.path(name)}, directory_.path(name + ".lcmlog"), false,
                           directory_.path("c.toml"));
  }

  /// Returns the samples that a log stores: axis, time and value.
  std::string samples(const std::string& name, std::optional<int> zone_min = {}) {
    std::vector<ConfigProblem> problems;
    const auto config = load_config(directory_.path("c.toml"), problems);
    EXPECT_TRUE(config) << test::told(problems);
    std::string out;
    const auto sink = [&](const estimator::AccelSample& s) {
      out += fmt::format("{} {} {}\n", s.axis, to_microseconds(s.time), s.accel);
    };
    drivers::AccelIntake intake({}, sink);
    EXPECT_EQ(push_stored_samples(*config, {directory_.path(name), false, {}, {}, zone_min}, intake,
                                  sink),
              "");
    return out;
  }

  test::TemporaryDirectory directory_;
};

TEST_F(CanLogReplay, GivesTheSameFromEveryFormat) {
  const test::ReplayOutcome candump = replayed("candump.log");
  EXPECT_EQ(candump.exit_code, 0) << candump.err;
  EXPECT_NE(candump.out.find("Accel.X: 300 values from 0.1 to 0.1"), std::string::npos)
      << candump.out;
  EXPECT_NE(candump.out.find("Accel.X: 300 values from -0.5 to -0.5"), std::string::npos);
  const std::string expected = test::read_file(directory_.path("candump.log.lcmlog"));
  const std::string stored = samples("candump.log");
  EXPECT_GT(std::count(stored.begin(), stored.end(), '\n'), kInstants);
  for (const char* name : {"nanoseconds.log", "vector.asc", "vector.blf"}) {
    const test::ReplayOutcome o = replayed(name);
    EXPECT_EQ(o.exit_code, 0) << o.err;
    EXPECT_EQ(test::read_file(directory_.path(std::string(name) + ".lcmlog")), expected) << name;
    EXPECT_EQ(samples(name), stored) << name;
    EXPECT_EQ(o.err.find("no time zone") != std::string::npos, name[0] == 'v') << o.err;
  }
  EXPECT_NE(samples("vector.blf", 60), stored);
}

TEST_F(CanLogReplay, NamesWhatItDoesNotRead) {
  const test::ReplayOutcome o = replayed("screen.log");
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_NE(o.err.find("screen.log: is what candump prints on a screen"), std::string::npos)
      << o.err;
  EXPECT_EQ(o.err.find("LCM"), std::string::npos) << o.err;
}

}  // namespace can_log_replay_test
}  // namespace framewatch::daemon
