// SPDX-License-Identifier: MIT
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/tools/demo/demo_command.h"

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "daemon/tools/demo/demo_network.h"
#include "daemon/tools/demo/demo_scenario.h"
#include "daemon/tools/demo/demo_view.h"

namespace framewatch::daemon {
namespace demo_test {

const std::map<std::string, double> kTruth{{"kx_1_y1", 20000}, {"Gk_1_x1y1", 5000}};

parameter_table_t example_table() {
  parameter_table_t table{};
  table.parameters = 2;
  table.name = {"kx_1_y1", "Gk_1_x1y1"};
  table.unit = {"N/m", "N/(rad*m)"};
  table.kind = {0, 1};
  table.story = {1, 1};
  table.design = {1, 1};
  return table;
}

window_estimate_t example_estimate(double kx, double gk) {
  window_estimate_t estimate{};
  estimate.status = 1;
  estimate.parameters = 2;
  estimate.value = {kx, gk};
  estimate.std_error = {1, 1};
  estimate.reason = {0, 0};
  estimate.snr = {100, 100};
  estimate.prior_share = estimate.noise_share = {0, 0};
  return estimate;
}

struct Outcome {
  int exit_code;
  std::string printed;
};

/// Returns the view's verdict after these messages, sent over LCM.
Outcome outcome(const parameter_table_t* table, const window_estimate_t& estimate) {
  drivers::LcmProvider lcm("memq://");
  DemoView view(kTruth, false, false);
  drivers::LcmSource source(lcm, DemoView::channels("T_"), 100,
                            [&](const drivers::LcmMessage& m) { view.message(m); });
  if (table) lcm.publish("T_PARAMETERS", table);
  lcm.publish("T_ESTIMATE", &estimate);
  EXPECT_TRUE(source.handle(0));
  testing::internal::CaptureStdout();
  const int exit_code = view.finish();
  return {exit_code, testing::internal::GetCapturedStdout()};
}

TEST(DemoView, PassesWithinItsLimits) {
  const parameter_table_t table = example_table();
  const Outcome o = outcome(&table, example_estimate(20190, 5240));
  EXPECT_EQ(o.exit_code, 0) << o.printed;
  EXPECT_NE(o.printed.find("HOLDS"), std::string::npos);
  EXPECT_NE(o.printed.find("+0.95"), std::string::npos) << o.printed;
  EXPECT_NE(o.printed.find("1 windows received, 1 valid"), std::string::npos);
}

TEST(DemoView, FailsBeyondItsLimits) {
  const parameter_table_t table = example_table();
  EXPECT_EQ(outcome(&table, example_estimate(20210, 5000)).exit_code, 1);
  EXPECT_EQ(outcome(&table, example_estimate(20000, 4700)).exit_code, 1);
  const Outcome o = outcome(&table, example_estimate(20210, 5000));
  EXPECT_NE(o.printed.find("FAILED"), std::string::npos);
  EXPECT_NE(o.printed.find("kx_1_y1"), std::string::npos);
}

TEST(DemoView, FailsWithoutAValueOrWithoutMessages) {
  const parameter_table_t table = example_table();
  window_estimate_t quiet = example_estimate(20000, std::numeric_limits<double>::quiet_NaN());
  quiet.reason = {0, 2};
  const Outcome o = outcome(&table, quiet);
  EXPECT_EQ(o.exit_code, 1);
  EXPECT_NE(o.printed.find("no value for Gk_1_x1y1"), std::string::npos) << o.printed;
  EXPECT_EQ(outcome(nullptr, example_estimate(20000, 5000)).exit_code, 1);
}

TEST(DemoView, SurvivesMalformedMessages) {
  drivers::LcmProvider lcm("memq://");
  DemoView view(kTruth, false, true);
  drivers::LcmSource source(lcm, DemoView::channels("T_"), 100,
                            [&](const drivers::LcmMessage& m) { view.message(m); });
  const std::string junk(200, '\xff');
  for (const char* channel : {"T_PARAMETERS", "T_ESTIMATE"})
    lcm.publish(channel, junk.data(), static_cast<unsigned>(junk.size()));
  EXPECT_TRUE(source.handle(0));
  EXPECT_EQ(view.finish(), 1);
}

TEST(DemoView, JudgesABuildingWithoutPanelsByItsFrames) {
  parameter_table_t table = example_table();
  table.kind = {0, 2};
  table.name[1] = "cx_1_y1";
  EXPECT_EQ(outcome(&table, example_estimate(20190, 1)).exit_code, 0);
  EXPECT_EQ(outcome(&table, example_estimate(20210, 1)).exit_code, 1);
}

TEST(Demo, FindsTheLossOfAGroupOfTwentyStories) {
  const DemoBuilding tall = demo_building(20);
  const auto before = truth_of(tall.scenario, tall.scenario.truth);
  const auto after = truth_of(tall.scenario, after_loss(tall));
  ASSERT_EQ(before.size(), 32u);
  for (const auto& [name, value] : before)
    EXPECT_NEAR(after.at(name) / value, name == tall.loses ? 1 - tall.loss_ratio : 1, 1e-12)
        << name;
}

TEST(Demo, TruthDiffersFromTheDesign) {
  const Scenario s = demo_scenario();
  EXPECT_EQ(s.config.pipeline.axes.size(), 10u);
  const Eigen::ArrayXd off = (s.truth.array() / s.config.pipeline.design.array() - 1).abs();
  const Eigen::Index stiffnesses = s.truth.size() / 2;
  EXPECT_GT(off.head(stiffnesses).minCoeff(), 0.05);
}

Outcome run(const std::string& command) {
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  std::string printed;
  char buffer[4096];
  while (const std::size_t got = std::fread(buffer, 1, sizeof buffer, pipe))
    printed.append(buffer, got);
  const int status = ::pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, printed};
}

const std::string kDemo = std::string(FRAMEWATCH_PROGRAM) + " demo --seconds 12";

TEST(Demo, FindsTheTableOverMulticast) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  const Outcome o = run(kDemo);
  EXPECT_EQ(o.exit_code, 0) << o.printed;
  EXPECT_NE(o.printed.find("UDP multicast that stays on this machine"), std::string::npos);
  EXPECT_NE(o.printed.find("HOLDS"), std::string::npos) << o.printed;
  EXPECT_NE(o.printed.find("Gk_2_x1y1"), std::string::npos);
}

TEST(Demo, CreatesANetworkWithoutMulticast) {
  if (run("unshare -rn true").exit_code != 0) GTEST_SKIP() << "no user namespaces here";
  const Outcome o = run("unshare -rn " + kDemo);
  EXPECT_EQ(o.exit_code, 0) << o.printed;
  EXPECT_NE(o.printed.find("private network namespace"), std::string::npos) << o.printed;
}

TEST(Demo, RunsInOneProcessWithoutANetwork) {
  const std::string forbid =
      "unshare -rn sh -c 'echo 0 > /proc/sys/user/max_net_namespaces && exec ";
  if (run(forbid + "true'").exit_code != 0) GTEST_SKIP() << "no user namespaces here";
  const Outcome o = run(forbid + kDemo + " --quiet'");
  EXPECT_EQ(o.exit_code, 0) << o.printed;
  EXPECT_EQ(o.printed.find("HOLDS"), 0u) << o.printed;
}

TEST(Demo, RefusesNonsense) {
  EXPECT_EQ(run(std::string(FRAMEWATCH_PROGRAM) + " demo --seconds -3").exit_code, 2);
  EXPECT_EQ(run(std::string(FRAMEWATCH_PROGRAM) + " demo extra").exit_code, 2);
}

}  // namespace demo_test
}  // namespace framewatch::daemon
