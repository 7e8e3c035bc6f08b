// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/expectation.h"

#include <gtest/gtest.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/tools/replay/replay_command.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace expectation_test {

using test::read_file;
using test::TemporaryDirectory;
using test::write_file;

Config table_building() {
  std::vector<ConfigProblem> problems;
  return *load_config(test::table_config(), problems);
}

/// Returns windows of one parameter that is `value`, and `other` from window `from` on.
EstimateSeries series_of(const estimator::ParameterTable& table, double value, int from,
                         double other) {
  EstimateSeries series(table, true);
  for (int w = 0; w < 100; ++w) {
    estimator::WindowEstimate e(static_cast<std::size_t>(table.size()));
    e.end = estimator::from_microseconds(1'000'000 + 10'000 * w);
    for (auto& reason : e.reason) reason = estimator::Observability::quiet;
    e.reason[0] =
        w == 50 ? estimator::Observability::channel_lost : estimator::Observability::observable;
    e.value[0] = w < from ? value : other;
    e.std_error[0] = 2;
    series.add(e);
  }
  return series;
}

class Expectation : public testing::Test {
 protected:
  std::vector<Check> check(const std::string& text, const EstimateSeries& series) {
    write_file(path(), "reason = \"test\"\n" + text);
    std::vector<ConfigProblem> problems;
    const auto expectations = load_expectations(path(), table_, problems);
    for (const ConfigProblem& p : problems) ADD_FAILURE() << p.where << ": " << p.message;
    if (!expectations) return {};
    return check_expectations(*expectations, {series, counts_, events_, 1'000'000});
  }
  std::string path() const { return directory_.path("expected.toml"); }

  TemporaryDirectory directory_;
  Config config_ = table_building();
  estimator::ParameterTable table_{config_.pipeline.structure};
  ReplayCounts counts_{{{"windows", 100},
                        {"gaps", 1},
                        {"lost", 0},
                        {"late", 0},
                        {"repaired", 0},
                        {"rejected", 0},
                        {"stuck", 0},
                        {"clipped", 0},
                        {"malformed", 0},
                        {"foreign", 0}}};
  std::vector<RaisedEvent> events_;
};

TEST_F(Expectation, HoldsWithinEachKindOfTolerance) {
  const EstimateSeries series = series_of(table_, 1000, 100, 0);
  for (const char* tolerance :
       {"tolerance = 10", "tolerance_ratio = 0.01", "tolerance_std_errors = 5"}) {
    for (const double expected : {1009.0, 1011.0}) {
      const auto checks = check(fmt::format("[[parameter]]\nname = \"{}\"\nmedian = {}\n{}\n",
                                            table_[0].name, expected, tolerance),
                                series);
      ASSERT_EQ(checks.size(), 1u);
      // 1 % of 1011 is 10.11 and the distance 11: outside for all three.
      EXPECT_EQ(checks[0].holds, expected < 1010) << tolerance;
    }
  }
}

TEST_F(Expectation, ReportsParameterExpectedFoundDistanceAndTime) {
  const EstimateSeries series = series_of(table_, 1000, 90, 1200);
  const auto checks = check(
      "[[parameter]]\nname = \"" + table_[0].name + "\"\nvalue = 1000\ntolerance_ratio = 0.01\n",
      series);
  ASSERT_EQ(checks.size(), 1u);
  EXPECT_FALSE(checks[0].holds);
  EXPECT_EQ(checks[0].first_s, 0.9);
  EXPECT_EQ(checks[0].found, 1200);
  EXPECT_EQ(checks[0].text(),
            table_[0].name +
                " value: expected 1000 N/m within 10 (1 %), found 1200: 200 off "
                "(+20.00 %); outside from 0.900 s on, farthest at 0.900 s (1200)");
}

TEST_F(Expectation, SpanLimitsTheWindows) {
  const EstimateSeries series = series_of(table_, 1000, 90, 1200);
  const std::string head =
      "[[parameter]]\nname = \"" + table_[0].name + "\"\nvalue = 1000\ntolerance = 1\n";
  EXPECT_TRUE(check(head + "to_s = 0.85\n", series)[0].holds);
  EXPECT_FALSE(check(head + "from_s = 0.85\n", series)[0].holds);
  EXPECT_FALSE(check(head + "from_s = 50\n", series)[0].holds) << "no window is no proof";
}

TEST_F(Expectation, ChecksSharesGroupsCountsAndEvents) {
  events_ = {{"stiffness_change", "kx_1_y2", 3'000'000}};
  const EstimateSeries series = series_of(table_, 1000, 100, 0);
  const auto checks = check(
      "[counts]\nwindows_min = 90\ngaps = 0\n"
      "[[parameter]]\ngroup = \"frame_stiffness\"\nobservable_min_ratio = 0.98\n"
      "[[parameter]]\nname = \"" +
          table_[0].name +
          "\"\nobservable_ratio = 0.99\n"
          "[[event]]\nkind = \"stiffness_change\"\nplace = \"kx_1_y2\"\nfrom_s = 1.5\nto_s = 2.5\n"
          "[[event]]\nkind = \"stiffness_change\"\nto_s = 1\n",
      series);
  int failed = 0;
  for (const Check& c : checks) failed += !c.holds;
  EXPECT_TRUE(checks[0].holds);
  EXPECT_EQ(checks[1].text(), "gaps count: expected 0, found 1: 1 off");
  EXPECT_TRUE(checks[2].holds);  // 99 of 100 windows of the first frame
  EXPECT_FALSE(checks[3].holds);
  EXPECT_EQ(checks[3].first_s, 0.0);
  EXPECT_TRUE(checks[checks.size() - 2].holds);
  EXPECT_FALSE(checks.back().holds);
  EXPECT_EQ(checks.back().first_s, 2.0);
  EXPECT_EQ(failed, 1 + 7 + 1);  // the other seven frames are never observable
}

TEST_F(Expectation, ReportsEveryProblemWithItsLine) {
  write_file(path(),
             "reason = \" \"\n"
             "[counts]\nwindow = 3\ngaps = -1\n"
             "[[parameter]]\nname = \"kx_1_y9\"\nmedian = 1\ntolerance = 1\n"
             "[[parameter]]\nname = \"kx_1_y1\"\nmedian = \"big\"\n"
             "[[parameter]]\ngroup = \"frames\"\nq1 = 3\ntolerance = 1\ntolerance_ratio = 2\n"
             "[[parameter]]\nname = \"kx_1_y1\"\n"
             "[[event]]\nfrom_s = 3\nto_s = 2\n");
  std::vector<ConfigProblem> problems;
  EXPECT_FALSE(load_expectations(path(), table_, problems));
  std::string all;
  for (const ConfigProblem& p : problems) all += p.where + ": " + p.message + "\n";
  for (const char* part : {":1:10: ", ":3:1: counts: unknown key window: did you mean windows?",
                           ":4:8: ", ":6:8: ", "did you mean \"kx_1_y",
                           ":11:10: ", ":13:9: ", ":16:19: ", ":17:1: ", ":21:8: "})
    EXPECT_NE(all.find(part), std::string::npos) << part << "\n" << all;
}

TEST_F(Expectation, RefusesAnythingButTomlAndEmptyFiles) {
  std::vector<ConfigProblem> problems;
  EXPECT_FALSE(load_expectations("/nonexistent.toml", table_, problems));
  write_file(path(), "reason = \"x\"\n");
  EXPECT_FALSE(load_expectations(path(), table_, problems));
  EXPECT_NE(problems.back().message.find("expects nothing"), std::string::npos);
  write_file(path(), "reason = \n[[");
  EXPECT_FALSE(load_expectations(path(), table_, problems));
}

TEST_F(Expectation, JunitCountsAndEscapes) {
  Check good, bad;
  good.subject = bad.subject = "a<b";
  good.holds = true;
  const std::string xml = junit_xml({good, bad}, "x\"&y");
  EXPECT_NE(xml.find("tests=\"2\" failures=\"1\""), std::string::npos) << xml;
  EXPECT_NE(xml.find("a&lt;b"), std::string::npos);
  EXPECT_NE(xml.find("x&quot;&amp;y"), std::string::npos);
}

TEST(ReplayExpect, WrittenExpectationsHoldAndAWrongOneIsReportedEverywhere) {
  const TemporaryDirectory directory;
  const auto path = [&](const char* name) { return directory.path(name); };
  test::record_table_test(path("rec.lcmlog"), 9);
  ReplayArguments a{test::table_config(), {path("rec.lcmlog")}, "", false, true, false};
  a.write_expect = path("expected.toml");
  ASSERT_EQ(replay(a), 0);
  a.write_expect.clear();
  a.expect = path("expected.toml");
  testing::internal::CaptureStderr();
  EXPECT_EQ(replay(a), 2) << "the reason is still to be filled in";
  EXPECT_NE(testing::internal::GetCapturedStderr().find("reason"), std::string::npos);

  std::string text = read_file(path("expected.toml"));
  text.replace(text.find("reason = \"\""), 11, "reason = \"scenario's truth\"");
  write_file(path("expected.toml"), text);
  a.junit = path("result.xml");
  EXPECT_EQ(replay(a), 0);
  EXPECT_NE(read_file(path("result.xml")).find("failures=\"0\""), std::string::npos);

  const std::size_t at = text.find("median = ") + 9;
  text.replace(at, text.find('\n', at) - at, "35123");
  write_file(path("expected.toml"), text);
  a.json = true;
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  EXPECT_EQ(replay(a), 1);
  const std::string err = testing::internal::GetCapturedStderr();
  EXPECT_NE(err.find("kx_1_y1 median: expected 35123 N/m within 351.2 (1 %), found "),
            std::string::npos)
      << err;
  EXPECT_NE(err.find("framewatch replay: 1 of "), std::string::npos) << err;
  const auto json = nlohmann::json::parse(testing::internal::GetCapturedStdout());
  ASSERT_EQ(json["differences"].size(), 1u);
  EXPECT_EQ(json["differences"][0]["subject"], "kx_1_y1");
  EXPECT_NE(read_file(path("result.xml")).find("failures=\"1\""), std::string::npos);
}

}  // namespace expectation_test
}  // namespace framewatch::daemon
