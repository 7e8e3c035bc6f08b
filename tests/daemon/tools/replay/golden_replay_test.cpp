// SPDX-License-Identifier: MIT
#include <cstdlib>

#include <gtest/gtest.h>

#include "daemon/base/file_digest.h"
#include "daemon/tools/replay/replay_command.h"
#include "daemon/tools/simulation/scenario.h"
#include "daemon/tools/simulation/simulation.h"
#include "drivers/can/can_log.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/support/can_traffic.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace golden_replay_test {

using test::read_file;
using test::TemporaryDirectory;

const std::string kGolden = FRAMEWATCH_SOURCE_DIR "/tests/golden/";
constexpr int kTowerInstants = 2000;

int golden_replay(const std::string& out) {
  ReplayArguments a{test::table_config(), {kGolden + "table.lcmlog.zst"}, out, false, true, false};
  a.expect = kGolden + "expected.toml";
  return replay(a);
}

/// Returns the digest over the payloads of every window of every length.
std::string digest_of_estimates(const std::string& path) {
  drivers::LcmLogReader reader;
  EXPECT_TRUE(reader.open(path));
  std::string bytes;
  for (drivers::LogEvent e; reader.next(e) == drivers::LogRead::event;)
    if (e.channel.starts_with("FRAMEWATCH_ESTIMATE")) bytes.append(e.data.begin(), e.data.end());
  return sha256(bytes);
}

std::string committed(const std::string& name) {
  return read_file(kGolden + name).substr(0, 64);
}

/// Writes the frames of the shaken tower's nodes as `candump -l` would.
void write_tower(const std::string& path) {
  std::vector<ConfigProblem> problems;
  const auto scenario =
      load_scenario(FRAMEWATCH_SOURCE_DIR "/configs/can/scenario_tower.toml", problems);
  ASSERT_TRUE(scenario.has_value());
  const drivers::CanMap& can = scenario->config.can;
  Simulation simulation(*scenario);
  drivers::CanEncoder encoder(can);
  drivers::CanLogWriter log;
  ASSERT_TRUE(log.open(path));
  for (int k = 0; k < kTowerInstants; ++k) {
    std::int64_t stamp_us = test::kTrafficStart_us + std::llround(1e6 / scenario->rate_hz * k);
    for (drivers::BusFrame& f : encoder.instant(simulation.next())) {
      f.frame.stamp_us = stamp_us += 270;
      ASSERT_TRUE(log.write(f.frame, can.buses[static_cast<std::size_t>(f.bus)].interface));
    }
  }
  ASSERT_TRUE(log.close());
}

TEST(GoldenReplay, IsAsExpected) {
  EXPECT_EQ(golden_replay(""), 0);
}

// All builds have one digest: debug, release and sanitizers do the same arithmetic. An intended
// change of last bits changes it; `framewatch diff` tells by how much.
TEST(GoldenReplay, GivesTheSameBytesInEveryBuild) {
  const TemporaryDirectory directory;
  ASSERT_EQ(golden_replay(directory.path("est.lcmlog")), 0);
  EXPECT_EQ(digest_of_estimates(directory.path("est.lcmlog")), committed("estimates.sha256"))
      << "the numbers changed: if they are meant to, put the first of these into "
         "tests/golden/estimates.sha256";
}

// Eighteen CANopen nodes, 20 s: the way of a gateway with a CAN interface.
TEST(GoldenReplay, ACanLogGivesTheSameBytesInEveryBuild) {
  const TemporaryDirectory directory;
  write_tower(directory.path("tower.log"));
  ASSERT_EQ(replay({FRAMEWATCH_SOURCE_DIR "/configs/can/tower.toml",
                    {directory.path("tower.log")},
                    directory.path("est.lcmlog"),
                    false,
                    true,
                    false}),
            0);
  EXPECT_EQ(digest_of_estimates(directory.path("est.lcmlog")), committed("can_estimates.sha256"))
      << "the numbers changed: if they are meant to, put the first of these into "
         "tests/golden/can_estimates.sha256";
}

TEST(GoldenReplay, FiveRunsGiveTheSameBytesWithAndWithoutATerminal) {
  const TemporaryDirectory directory;
  ASSERT_EQ(golden_replay(directory.path("0.lcmlog")), 0);
  const std::string first = read_file(directory.path("0.lcmlog"));
  for (int run = 1; run < 5; ++run) {
    const std::string out = directory.path(std::to_string(run) + ".lcmlog");
    std::string command = std::string(FRAMEWATCH_PROGRAM) + " replay " + test::table_config() +
                          " " + kGolden + "table.lcmlog.zst --out " + out;
    if (run % 2 == 0) command = "script -qec '" + command + "' /dev/null";
    ASSERT_EQ(std::system((command + " > /dev/null").c_str()), 0) << command;
    EXPECT_TRUE(read_file(out) == first) << command;
  }
}

TEST(GoldenReplay, TheRecipeGivesTheGoldenLog) {
  const TemporaryDirectory directory;
  const std::string made = directory.path("made.lcmlog"), golden = directory.path("golden.lcmlog");
  ASSERT_EQ(std::system((std::string(FRAMEWATCH_PROGRAM) + " simulate " + kGolden +
                         "scenario.toml --quiet --out " + made + " && zstd -q -d " + kGolden +
                         "table.lcmlog.zst -o " + golden)
                            .c_str()),
            0);
  EXPECT_TRUE(read_file(made) == read_file(golden));
}

}  // namespace golden_replay_test
}  // namespace framewatch::daemon
