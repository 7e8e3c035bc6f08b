// SPDX-License-Identifier: MIT
#include "daemon/tools/simulation/simulate_command.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace simulate_command_test {

const std::string kScenario = FRAMEWATCH_SOURCE_DIR "/configs/scenario_table_two_story.toml";

SimulateArguments arguments(const std::string& scenario, const std::string& out,
                            double seconds = -1) {
  SimulateArguments a;
  a.scenario = scenario;
  a.out = out;
  a.seconds = seconds;
  a.quiet = true;
  return a;
}

int run(const SimulateArguments& a) {
  testing::internal::CaptureStderr();
  const int code = simulate(a);
  testing::internal::GetCapturedStderr();
  return code;
}

TEST(Simulate, WritesEveryInstantUnderTheConfiguredNames) {
  const test::TemporaryDirectory directory;
  ASSERT_EQ(run(arguments(kScenario, directory.path("rec.csv"), 2)), 0);
  const std::string csv = test::read_file(directory.path("rec.csv"));
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "time_s,base-x,base-y,F1-Y1,F1-Y2,F1-X1,F1-X2,F2-Y1,F2-Y2,F2-X1,F2-X2");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 202);
  EXPECT_EQ(directory.names(), std::vector<std::string>{"rec.csv"});
}

TEST(Simulate, MayWriteAndSendAtOnce) {
  const test::TemporaryDirectory directory;
  SimulateArguments a = arguments(kScenario, directory.path("rec.lcmlog"), 0.5);
  a.lcm = true;
  a.lcm_url = "memq://";
  a.speed = 100;
  ASSERT_EQ(run(a), 0);
  EXPECT_EQ(directory.names(), std::vector<std::string>{"rec.lcmlog"});
}

TEST(Simulate, BadInputExitsTwoAndWritesNothing) {
  const test::TemporaryDirectory directory;
  const std::string out = directory.path("rec.csv");
  test::write_file(directory.path("bad.toml"), "config = \"nowhere.toml\"\nsed = 3\n");
  EXPECT_EQ(run(arguments(directory.path("bad.toml"), out)), 2);
  EXPECT_EQ(run(arguments(directory.path("none.toml"), out)), 2);
  EXPECT_EQ(run(arguments(kScenario, "")), 2);
  EXPECT_EQ(run(arguments(kScenario, directory.path("rec.mat"))), 2);
  EXPECT_EQ(run(arguments(kScenario, directory.path("no/rec.csv"))), 2);
  SimulateArguments nowhere = arguments(kScenario, out, 1);
  nowhere.lcm = true;
  nowhere.lcm_url = "bogus://";
  EXPECT_EQ(run(nowhere), 2);
  EXPECT_EQ(directory.names(), std::vector<std::string>{"bad.toml"});
}

}  // namespace simulate_command_test
}  // namespace framewatch::daemon
