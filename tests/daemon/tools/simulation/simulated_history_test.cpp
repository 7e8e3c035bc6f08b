// SPDX-License-Identifier: MIT
// Tests `framewatch simulate --history`: years of a climate, and that `framewatch history --losses`
// finds in them what the scenario hides.
#include "daemon/tools/simulation/simulated_history.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/base/sqlite_file.h"
#include "daemon/monitor/history/history_command.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/tools/simulation/scenario.h"
#include "daemon/tools/simulation/simulate_command.h"
#include "daemon/tools/simulation/simulation.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace simulated_history_test {

constexpr double kDay_s = 86400;

std::string scenario_text(double days, const std::string& more) {
  return fmt::format("config = \"{}/configs/table_two_story.toml\"\nduration_s = {}\nseed = 3\n{}",
                     FRAMEWATCH_SOURCE_DIR, days * kDay_s, more);
}

class SimulatedHistory : public testing::Test {
 protected:
  int simulate_into(const std::string& folder, const std::string& text) {
    test::write_file(directory_.path("s.toml"), text);
    SimulateArguments a;
    a.scenario = directory_.path("s.toml");
    a.history = directory_.path(folder);
    a.weather = directory_.path(folder + ".csv");
    a.quiet = true;
    testing::internal::CaptureStderr();
    const int code = simulate(a);
    problems_ = testing::internal::GetCapturedStderr();
    return code;
  }
  nlohmann::json losses_of(const std::string& folder) {
    HistoryArguments a;
    a.place = directory_.path(folder);
    a.losses = a.json = true;
    testing::internal::CaptureStdout();
    code_ = history(a);
    return nlohmann::json::parse(testing::internal::GetCapturedStdout());
  }

  test::TemporaryDirectory directory_;
  std::string problems_;
  int code_ = -1;
};

TEST_F(SimulatedHistory, HistoryFindsTheLossInTheWeather) {
  const std::string loss = fmt::format(
      "[climate]\n[[change]]\nat_s = {0}\nparameter = \"ky_1_x2\"\nfactor = 0.95\n"
      "[[change]]\nat_s = {0}\nparameter = \"cy_1_x2\"\nfactor = 1.8\n",
      200 * kDay_s);
  ASSERT_EQ(simulate_into("h", scenario_text(220, loss)), 0) << problems_;
  const nlohmann::json found = losses_of("h");
  EXPECT_EQ(code_, 1);
  ASSERT_EQ(found.at("losses").size(), 1) << found.dump(1);
  ASSERT_EQ(found.at("damping").size(), 1) << found.dump(1);
  EXPECT_EQ(found.at("damping")[0].at("parameter"), "cy_1_x2");
  const nlohmann::json& one = found.at("losses")[0];
  EXPECT_EQ(one.at("parameter"), "ky_1_x2");
  EXPECT_EQ(one.at("since"), "2026-07-20");  // 200 days after 2026-01-01
  EXPECT_NEAR(one.at("ratio").get<double>(), -0.05, 4 * one.at("std_error").get<double>());
}

TEST_F(SimulatedHistory, AHealthyBuildingLosesNothing) {
  ASSERT_EQ(simulate_into("h", scenario_text(100, "[climate]\n")), 0) << problems_;
  const nlohmann::json healthy = losses_of("h");
  EXPECT_EQ(healthy.at("losses").size(), 0);
  EXPECT_EQ(healthy.at("damping").size(), 0);
  EXPECT_EQ(healthy.at("weather").size(), 4);  // the history has it
  EXPECT_EQ(code_, 0);
  const std::string weather = test::read_file(directory_.path("h.csv"));
  EXPECT_EQ(std::count(weather.begin(), weather.end(), '\n'), 1 + 100 * 24);
  EXPECT_TRUE(weather.starts_with(
      "time,outside_degc,humidity_pct,wind_mps,occupied_pct\n2026-01-01T00:00:00Z,"));
}

/// Returns the summaries of hours in a history, as text.
std::string hours_in(const std::string& folder) {
  SqliteFile file;
  EXPECT_TRUE(file.open_to_read(summary_file(folder)));
  SqliteStatement all = file.prepare(
      "SELECT parameter, start_us, observable, mean, std_error, min, q1, median, q3, max"
      " FROM summary WHERE period_s = 3600 ORDER BY parameter, start_us");
  std::string out;
  while (all.row()) {
    out += fmt::format("{} {} {}", all.integer(0), all.integer(1), all.integer(2));
    for (int column = 3; column < 10; ++column) out += fmt::format(" {}", all.number(column));
    out += "\n";
  }
  return out;
}

TEST_F(SimulatedHistory, HoursAreTheSameBesideSummariesOfDays) {
  const std::string building =
      test::read_file(std::string(FRAMEWATCH_SOURCE_DIR) + "/configs/table_two_story.toml");
  for (const char* lengths : {"60, 3600", "60, 3600, 86400"}) {
    test::write_file(
        directory_.path("b.toml"),
        building + fmt::format("\n[history]\ndirectory = \"none\"\nsummary_s = [{}]\n", lengths));
    const std::string text =
        fmt::format("config = \"b.toml\"\nduration_s = {}\nseed = 3\n[climate]\n", 10 * kDay_s);
    ASSERT_EQ(simulate_into(lengths, text), 0) << problems_;
  }
  const std::string alone = hours_in(directory_.path("60, 3600"));
  EXPECT_GT(std::count(alone.begin(), alone.end(), '\n'), 10 * 24);
  EXPECT_EQ(alone, hours_in(directory_.path("60, 3600, 86400")));
}

TEST_F(SimulatedHistory, TheSameScenarioGivesTheSameWeather) {
  const std::string text = scenario_text(3, "[climate]\n");
  ASSERT_EQ(simulate_into("a", text), 0);
  ASSERT_EQ(simulate_into("b", text), 0);
  EXPECT_EQ(test::read_file(directory_.path("a.csv")), test::read_file(directory_.path("b.csv")));
  // The folder is not empty any more.
  EXPECT_EQ(simulate_into("a", text), 2);
  EXPECT_NE(problems_.find("is not empty"), std::string::npos) << problems_;
}

TEST_F(SimulatedHistory, TellsWhatItCannotDo) {
  EXPECT_EQ(simulate_into("h", scenario_text(3, "")), 2);
  EXPECT_NE(problems_.find("need a [climate]"), std::string::npos) << problems_;
  EXPECT_EQ(simulate_into("h", scenario_text(3,
                                             "[climate]\nstart = \"spring\"\n"
                                             "shortest_lag_days = 4\nlongest_lag_days = 3\n")),
            2);
  EXPECT_NE(problems_.find("\"spring\" is not a time"), std::string::npos) << problems_;
  EXPECT_NE(problems_.find("is shorter than shortest_lag_days"), std::string::npos) << problems_;
  SimulateArguments a;
  a.scenario = directory_.path("s.toml");
  a.out = directory_.path("o.csv");
  a.weather = directory_.path("w.csv");
  testing::internal::CaptureStderr();
  EXPECT_EQ(simulate(a), 2);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("--weather goes with --history"),
            std::string::npos);
}

/// Returns the largest acceleration of a channel in a scenario.
double peak(const Scenario& s, std::size_t channel) {
  Simulation simulation(s);
  double out = 0;
  for (std::int64_t i = 0; i < instants(s); ++i)
    out = std::max(out, std::abs(simulation.next()[channel]));
  return out;
}

TEST_F(SimulatedHistory, MotionToo) {
  std::vector<ConfigProblem> problems;
  const auto read = [&](const std::string& more) {
    return read_scenario(scenario_text(0.0002, more), "s.toml", problems);
  };
  // The building is as if all stiffnesses were those of the cold hour.
  const auto cold = read("[climate]\nmean_degc = 0\nseason_degc = 40\nper_degc = -0.05\n");
  const auto mild = read("");
  ASSERT_TRUE(cold && mild);
  estimator::ClimateStream climate = climate_of(*cold);
  climate.next();
  Scenario same = *mild;
  same.truth = weathered(same.truth, climate);
  EXPECT_GT(climate.stiffness_factor()[0], 1.5);
  const std::size_t roof = same.config.pipeline.axes.size() - 1;
  EXPECT_EQ(peak(*cold, roof), peak(same, roof));
  EXPECT_NE(peak(*cold, roof), peak(*mild, roof));
  EXPECT_FALSE(read("[sensors]\ngain_per_degc = 1e-4\n"));
  ASSERT_FALSE(problems.empty());
  EXPECT_NE(problems.back().message.find("needs [climate]"), std::string::npos);
}

}  // namespace simulated_history_test
}  // namespace framewatch::daemon
