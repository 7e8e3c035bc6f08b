// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>

#include "daemon/tools/commands/check_command.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/tools/commands/check_report.h"
#include "tests/support/config_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace check_command_test {

using test::kGoodConfig;

std::string with_design(const std::string& design) {
  return std::string(kGoodConfig) + "[structure.design]\n" + design;
}

bool warns(const CheckReport& report, const std::string& part) {
  for (const std::string& warning : report.warnings)
    if (warning.find(part) != std::string::npos) return true;
  return false;
}

/// Returns the exit status of the program; its output is in `out`.
int run_check(const std::string& arguments, std::string& out) {
  const test::TemporaryDirectory directory;
  const std::string file = directory.path("out");
  const std::string command =
      std::string(FRAMEWATCH_PROGRAM) + " check " + arguments + " > " + file + " 2>&1";
  const int status = std::system(command.c_str());
  out = test::read_file(file);
  return WEXITSTATUS(status);
}

TEST(Check, SymmetricPlanCannotIdentifyPanels) {
  const CheckReport r =
      make_check_report(test::good(with_design("kx_npm = 2e4\nky_npm = 3e4\ngk = 4e4\n")));
  ASSERT_EQ(r.panels.size(), 1u);
  EXPECT_LT(r.panels[0].shear_ratio, 1e-12);
  EXPECT_TRUE(warns(r, "the plan is symmetric")) << to_text(r);
  EXPECT_TRUE(warns(r, "Gk_1_x1y1"));
}

TEST(Check, ManyPanelsAreCounted) {
  const std::string text = test::replaced(
      test::replaced(
          test::replaced(with_design("kx_npm = 2e4\nky_npm = 3e4\n"), "[\"x1\", \"x2\"]",
                         "[\"x1\", \"x2\", \"x3\", \"x4\", \"x5\", \"x6\", \"x7\", \"x8\", "
                         "\"x9\"]"),
          "span_x_m = [1.0]", "span_x_m = [1, 1, 1, 1, 1, 1, 1, 1]"),
      "[[channel]]\nname = \"base-x\"", [] {
        std::string more;
        for (int i = 3; i < 10; ++i)
          more += "[[channel]]\nname = \"m" + std::to_string(i) + "\"\nstory = 1\nframe = \"x" +
                  std::to_string(i) + "\"\n\n";
        return more + "[[channel]]\nname = \"base-x\"";
      }());
  const CheckReport r = make_check_report(test::good(text));
  EXPECT_TRUE(warns(r, "Gk_1_x5y1, Gk_1_x6y1, 2 more and their damping")) << to_text(r);
}

TEST(Check, EccentricPlanDoesNotWarn) {
  const CheckReport r =
      make_check_report(test::good(with_design("kx_npm = [[2e4, 3e4]]\nky_npm = 3e4\ngk = 4e4\n")));
  ASSERT_EQ(r.panels.size(), 1u);
  EXPECT_GT(r.panels[0].shear_ratio, 0.05);
  EXPECT_TRUE(r.warnings.empty()) << to_text(r);
}

TEST(Check, NearlySymmetricPlanWarnsMildly) {
  const CheckReport r = make_check_report(
      test::good(with_design("kx_npm = [[2e4, 2.001e4]]\nky_npm = 3e4\ngk = 4e4\n")));
  EXPECT_TRUE(warns(r, "nearly symmetric")) << to_text(r);
}

TEST(Check, UnequalMassesMakeASymmetricStiffnessEccentric) {
  const std::string text =
      test::replaced(with_design("kx_npm = 2e4\nky_npm = 3e4\ngk = 4e4\n"), "node_mass_kg = 20.0",
                     "node_mass_kg = [[[20, 20], [40, 40]]]");
  EXPECT_TRUE(make_check_report(test::good(text)).warnings.empty());
}

TEST(Check, RateTooLowForTheHighestDesignFrequencyWarns) {
  const CheckReport r =
      make_check_report(test::good(with_design("kx_npm = [[2e6, 3e6]]\nky_npm = 3e6\ngk = 4e6\n")));
  ASSERT_GT(r.design_hz.back(), 20);
  EXPECT_TRUE(warns(r, "above a fifth of the sampling rate, 20 Hz")) << to_text(r);
}

TEST(Check, ReportsRounding) {
  const CheckReport r = make_check_report(
      test::good(std::string(kGoodConfig) + "[estimator]\nrate_hz = 120\nhop_s = 0.01\n"));
  EXPECT_EQ(r.hop_rows, 1);
  EXPECT_EQ(r.window_rows, 600);
  EXPECT_TRUE(warns(r, "estimator.hop_s: 0.01 s becomes 0.00833333 s")) << to_text(r);
}

TEST(CheckCommand, SummarizesAGoodConfigurationAndExitsZero) {
  std::string out;
  EXPECT_EQ(run_check(std::string(FRAMEWATCH_SOURCE_DIR) + "/configs/paper_table2.toml", out), 0)
      << out;
  for (const char* part : {"16 degrees of freedom", "68: kx_1_y1 ... Gc_2_x3y3", "7.740 Hz",
                           "window 500 samples", "F2-X4", "udpm://"})
    EXPECT_NE(out.find(part), std::string::npos) << part << " in\n" << out;
}

TEST(CheckCommand, ReportsEveryProblemOfABadConfigurationAndExitsTwo) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("bad.toml");
  test::write_file(path, test::replaced(test::replaced(kGoodConfig, "stories = 1", "stores = 1"),
                                        "story = 0", "story = -1"));
  std::string out;
  EXPECT_EQ(run_check(path, out), 2);
  EXPECT_NE(out.find(path + ":2:1: structure: unknown key stores: did you mean stories?"),
            std::string::npos)
      << out;
  EXPECT_NE(out.find(path + ":12:9: channel 'base-x'.story: must be >= 0"), std::string::npos)
      << out;
}

TEST(CheckCommand, PrintsTwentyProblemsAndCountsTheOthers) {
  constexpr int kProblems = 30'000, kPrinted = 20;
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("bad.toml");
  std::string text = kGoodConfig;
  for (int i = 0; i < kProblems; ++i) text += "unknown_" + std::to_string(i) + " = 1\n";
  test::write_file(path, text);
  std::string out;
  EXPECT_EQ(run_check(path, out), 2);
  EXPECT_EQ(std::count(out.begin(), out.end(), '\n'), kPrinted + 2) << out.substr(0, 5000);
  EXPECT_NE(out.find("and 29980 more problems"), std::string::npos);
  EXPECT_NE(out.find(path + ": 30000 problems"), std::string::npos);
}

TEST(CheckCommand, JsonHasTheProblems) {
  std::string out;
  EXPECT_EQ(run_check("--json /nowhere.toml", out), 2);
  const auto json = nlohmann::json::parse(out);
  EXPECT_EQ(json["schema"], "framewatch.check/1");
  EXPECT_EQ(json["good"], false);
  EXPECT_EQ(json["problems"][0]["where"], "/nowhere.toml");
}

TEST(CheckCommand, JsonHasTheSummary) {
  std::string out;
  EXPECT_EQ(
      run_check("--json " + std::string(FRAMEWATCH_SOURCE_DIR) + "/configs/table_two_story.toml",
                out),
      0);
  const auto json = nlohmann::json::parse(out);
  EXPECT_EQ(json["good"], true);
  EXPECT_EQ(json["parameters"].size(), 20u);
  EXPECT_EQ(json["channels"].size(), 10u);
  EXPECT_EQ(json["channels"][2]["source"]["node"], 2);
}

TEST(CheckCommand, NeedsAFile) {
  std::string out;
  EXPECT_EQ(run_check("", out), 2);
}

}  // namespace check_command_test
}  // namespace framewatch::daemon
