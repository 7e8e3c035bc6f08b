// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/refine_command.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/monitor/estimation/segment_collector.h"
#include "daemon/tools/simulation/simulate_command.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace refine_command_test {

const std::string kConfigs = FRAMEWATCH_SOURCE_DIR "/configs/";
const std::string kConfig = kConfigs + "table_two_story.toml";

struct Outcome {
  int exit_code;
  std::string out, err;
};

Outcome refined(const RefineArguments& arguments) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code = refine(arguments);
  return {code, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
}

class RefineCommand : public testing::Test {
 protected:
  std::string record(const std::string& name) {
    SimulateArguments arguments;
    arguments.scenario = kConfigs + "scenario_table_two_story.toml";
    arguments.out = directory_.path(name);
    arguments.seconds = 12;
    arguments.quiet = true;
    EXPECT_EQ(simulate(arguments), 0);
    return arguments.out;
  }
  test::TemporaryDirectory directory_;
};

TEST_F(RefineCommand, FindsTheTruthWithinItsStatedErrors) {
  // GIVEN the virtual table test and its scenario's truth, N/m
  const std::pair<const char*, double> truth[] = {{"kx_1_y1", 34e3}, {"kx_1_y2", 25e3},
                                                  {"kx_2_y1", 28e3}, {"ky_1_x1", 26e3},
                                                  {"ky_2_x2", 29e3}, {"Gk_1_x1y1", 38e3}};
  constexpr double kErrors = 4;
  for (const char* name : {"rec.csv", "rec.lcmlog"}) {
    // WHEN five seconds of it are refined
    const Outcome o = refined({kConfig, {record(name)}, 6, 11, true, true});
    ASSERT_EQ(o.exit_code, 0) << o.err << o.out;
    const auto json = nlohmann::json::parse(o.out);
    EXPECT_EQ(json["status"], "converged");
    ASSERT_EQ(json["parameters"].size(), 20u);
    // THEN every stiffness is within its stated error, and no error is far below the bound
    for (const auto& parameter : json["parameters"]) {
      for (const auto& [wanted, value] : truth) {
        if (parameter["name"] != wanted) continue;
        const double error = parameter["std_error"];
        EXPECT_LT(std::abs(parameter["refined"].get<double>() - value), kErrors * error) << wanted;
        EXPECT_LT(error, 0.1 * value) << wanted;
        EXPECT_GT(error, 0) << wanted;
        EXPECT_TRUE(parameter["streaming"].is_number()) << wanted;
      }
    }
  }
}

TEST_F(RefineCommand, PrintsATable) {
  const Outcome o = refined({kConfig, {record("rec.csv")}, 6, -1, true, false});
  EXPECT_EQ(o.exit_code, 0) << o.err;
  EXPECT_NE(o.out.find("6.000 s to 11.000 s: converged"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("\nkx_1_y1 "), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("Cramer-Rao bound"), std::string::npos) << o.out;
}

TEST_F(RefineCommand, ReportsWhyItCannotRefine) {
  const std::string rec = record("rec.csv");
  EXPECT_EQ(refined({kConfig, {rec}, 6, 6.05, true, false}).exit_code, 1);
  const Outcome beyond = refined({kConfig, {rec}, 600, 605, true, false});
  EXPECT_EQ(beyond.exit_code, 1);
  EXPECT_NE(beyond.out.find("too short"), std::string::npos) << beyond.out;
  EXPECT_EQ(refined({kConfig, {rec}, 6, 5, true, false}).exit_code, 2);
  EXPECT_EQ(refined({kConfig, {directory_.path("none.csv")}, 6, 11, true, false}).exit_code, 2);
  EXPECT_EQ(refined({directory_.path("none.toml"), {rec}, 6, 11, true, false}).exit_code, 2);
}

TEST(SegmentCollector, CalibratesAndMarksLostSamples) {
  estimator::PipelineConfig config;
  config.options.rate_hz = 100;
  config.axes.resize(2);
  config.axes[0].scale = 2;
  config.axes[0].offset = 1;
  config.axes[1].delay = 0.024;  // two samples and 4 ms
  SegmentCollector collector(config, 0.1, 0.3);
  for (int i = 0; i <= 60; ++i) {
    const estimator::Time time = estimator::from_microseconds(1'000'000 + 10'000 * i);
    if (i < 18 || i > 21) collector.push({time, 0, static_cast<double>(i)});
    collector.push({time, 1, static_cast<double>(i)});
  }
  collector.finish();
  const Eigen::MatrixXd accel = collector.accel();
  ASSERT_EQ(accel.rows(), 21);
  EXPECT_DOUBLE_EQ(accel(0, 0), 2 * 10 - 1);
  EXPECT_DOUBLE_EQ(accel(0, 1), 12);
  EXPECT_TRUE(std::isnan(accel(9, 0)));
  EXPECT_NEAR(collector.axes()[1].delay, 0.004, 1e-12);
}

}  // namespace refine_command_test
}  // namespace framewatch::daemon
