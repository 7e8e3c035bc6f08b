// SPDX-License-Identifier: MIT
// Tests the report after strong motion: the verdict by thresholds, the files, their number, and the
// event that names them.
#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/event_report/event_report.h"
#include "daemon/monitor/event_report/event_report_files.h"
#include "daemon/monitor/events/event_messages.h"
#include "estimator/numeric/nan.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace event_report_test {

class EventReportTest : public testing::Test {
 protected:
  EventReportTest() {
    test::write_file(directory_.path("building.toml"),
                     test::read_file(test::table_config()) +
                         "\n[event_report]\ndirectory = \"reports\"\nmost_reports = 3\n");
    std::vector<ConfigProblem> problems;
    config_ = load_config(directory_.path("building.toml"), problems);
    EXPECT_TRUE(config_) << (problems.empty() ? "" : problems.front().message);
    const estimator::Structure& s = config_->pipeline.structure;
    estimator::Shaking& shaking = report_.shaking;
    shaking.start = estimator::from_microseconds(1'795'481'188'000'000);
    shaking.end = shaking.start + std::chrono::seconds(15);
    shaking.found = shaking.end + std::chrono::seconds(20);
    shaking.peak.accel_mps2.assign(config_->pipeline.axes.size(), 1.5);
    shaking.peak.drift_m.assign(static_cast<std::size_t>(s.degrees_of_freedom()), 0.001);
    estimator::ShakenStiffness k;
    k.before = {1000, 5, 3};
    k.during = k.after = k.before;
    k.before_from = estimator::BeforeFrom::windows_before;
    shaking.stiffness.assign(static_cast<std::size_t>(estimator::ParameterTable(s).elements()), k);
    shaking.gap_nrmse = estimator::kNaN;
    report_.axes.resize(config_->pipeline.axes.size());
  }
  EventVerdict verdict() const { return judge(report_, *config_); }

  test::TemporaryDirectory directory_;
  std::optional<Config> config_;
  EventReport report_;
};

TEST_F(EventReportTest, IsGreenBelowEveryThreshold) {
  EXPECT_EQ(verdict().color, EventColor::green);
  const event_t m = event_of(report_, *config_);
  EXPECT_EQ(m.severity, severity::information);
  EXPECT_FALSE(green_and_past(m, m.time_us + 599'000'000));
  EXPECT_TRUE(green_and_past(m, m.time_us + 600'000'000));
  EXPECT_EQ(m.kind, "strong_motion");
  EXPECT_EQ(m.segment, "event-20261124T004628Z.html");
  EXPECT_NE(m.message.find(m.segment), std::string::npos);
  const auto told = nlohmann::json::parse(event_json(m, "the table"));
  EXPECT_EQ(told["segment"], m.segment);  // as the webhook posts it and the command reads it
}

TEST_F(EventReportTest, IsYellowOrRedByDrift) {
  report_.shaking.peak.drift_m[0] = 0.006;  // of 1 m
  EXPECT_EQ(verdict().color, EventColor::yellow);
  EXPECT_NE(verdict().reasons.front().find("story 1 drifted by 0.60 %"), std::string::npos);
  report_.shaking.peak.drift_m.back() = 0.02;
  EXPECT_EQ(verdict().color, EventColor::red);
  EXPECT_NE(verdict().reasons.front().find("story 2 drifted by 2.00 %"), std::string::npos);
  EXPECT_EQ(event_of(report_, *config_).severity, severity::alarm);
  EXPECT_EQ(event_of(report_, *config_).place, "story 2");
  EXPECT_FALSE(green_and_past(event_of(report_, *config_), INT64_MAX));
}

TEST_F(EventReportTest, StartsWithMissingSamples) {
  const estimator::Time start = report_.shaking.start;
  report_.shaking.drift_settles_s = 7;
  report_.shaking.unheard = {{start + std::chrono::seconds(4), start + std::chrono::seconds(32),
                              true, estimator::UnheardWhy::restart}};
  const std::string said =
      "Nobody listened from 00:46:32 to 00:47:00 (28 s): peaks in that time are not known; drifts "
      "are known again from 00:47:07 on";
  EXPECT_EQ(verdict().color, EventColor::yellow);
  EXPECT_EQ(verdict().reasons.front(), said);
  report_.shaking.peak.drift_m.back() = 0.02;
  EXPECT_EQ(verdict().color, EventColor::red);
  EXPECT_NE(verdict().reasons.front().find("by at least 2.00 %"), std::string::npos);
  const std::string html = event_report_html(report_, *config_);
  EXPECT_LT(html.find(said), html.find("Red: "));
  EXPECT_EQ(html.find(said), html.rfind(said));  // once
  const auto json = nlohmann::json::parse(event_report_json(report_, *config_));
  ASSERT_EQ(json["unheard"].size(), 1u);
  EXPECT_EQ(json["unheard"][0]["seconds"], 28.0);
  EXPECT_EQ(json["unheard"][0]["why"], "restart");
  EXPECT_EQ(json["unheard"][0]["message"], said);
  EXPECT_NE(event_of(report_, *config_).message.find("28 s of it were not heard; red"),
            std::string::npos);
  estimator::Unheard& u = report_.shaking.unheard[0];
  u.why = estimator::UnheardWhy::restart_no_raw;
  EXPECT_NE(event_report_html(report_, *config_).find("[history] stores them"), std::string::npos);
  u.why = estimator::UnheardWhy::no_samples;
  EXPECT_NE(event_report_html(report_, *config_).find("No samples came from"), std::string::npos);
  u.from_known = false;
  EXPECT_NE(event_report_html(report_, *config_).find("Nobody listened before 00:47:00"),
            std::string::npos);
  EXPECT_TRUE(nlohmann::json::parse(event_report_json(report_, *config_))["unheard"][0]["from_us"]
                  .is_null());
}

TEST_F(EventReportTest, NamesComputedDrifts) {
  EXPECT_EQ(event_report_html(report_, *config_).find("computed"), std::string::npos);
  std::vector<ConfigProblem> problems;
  const auto partial = parse_config("six.toml", R"([structure]
stories = 6
frames_x = ["y1"]
story_height_m = 3.5
node_mass_kg = 300e3
[structure.design]
kx_npm = 400e6
damping_ratio = 0.02
[event_report]
directory = "reports"
[[channel]]
name = "base"
story = 0
direction = "x"
[[channel]]
name = "F1"
story = 1
frame = "y1"
[[channel]]
name = "F3"
story = 3
frame = "y1"
check = true
[[channel]]
name = "roof"
story = 6
frame = "y1"
)",
                                    problems);
  ASSERT_TRUE(partial);
  report_.shaking.peak.accel_mps2.assign(4, 1.5);
  report_.shaking.peak.drift_m.assign(6, 0.003);
  report_.shaking.peak.drift_m[3] = 0.03;  // story 4
  report_.shaking.stiffness.clear();
  report_.shaking.stiffness.resize(
      static_cast<std::size_t>(partial->pipeline.parameters().elements()));
  report_.axes.resize(4);
  const std::string html = event_report_html(report_, *partial);
  EXPECT_NE(html.find("that drift is"), std::string::npos);
  EXPECT_NE(judge(report_, *partial).reasons.front().find("(computed, limit"), std::string::npos);
  const auto told = nlohmann::json::parse(event_report_json(report_, *partial));
  for (const auto& story : told["stories"])
    EXPECT_EQ(story["drift_is"], story["story"] == 1 ? "measured" : "computed") << story;
}

TEST_F(EventReportTest, AnUnfinishedRecordIsNeverGreen) {
  estimator::ShakenStiffness& k = report_.shaking.stiffness[1];
  k.watched = true;
  k.record.id = 1;
  k.record.state = estimator::ChangeState::changing;
  k.record.change.ratio = -0.02;
  EXPECT_EQ(verdict().color, EventColor::yellow);
  EXPECT_NE(verdict().reasons.front().find("is changing"), std::string::npos);
  EXPECT_FALSE(k.known());
  k.record.state = estimator::ChangeState::measured;
  k.record.change.std_error = 0.001;
  EXPECT_EQ(verdict().color, EventColor::yellow);  // below the threshold, and open
  EXPECT_EQ(k.ratio(), -0.02);
  EXPECT_EQ(k.std_error(), 0.001);
  k.record.change.ratio = -0.3;
  EXPECT_EQ(verdict().color, EventColor::red);
}

TEST_F(EventReportTest, ReportsNoLossThatWatchDoesNotReport) {
  report_.shaking.stiffness[1].after.value = 900;
  report_.shaking.stiffness[1].watched = true;
  EXPECT_EQ(verdict().color, EventColor::green);
}

TEST_F(EventReportTest, IsYellowIfEveryElementChangesAlike) {
  report_.everything.id = 1;
  report_.everything.state = estimator::ChangeState::measured;
  report_.everything.change.ratio = -0.05;
  report_.everything.change.std_error = 0.004;
  EXPECT_EQ(verdict().color, EventColor::yellow);
  EXPECT_NE(verdict().reasons.front().find("everything softened alike by 5.0 %"),
            std::string::npos);
}

TEST_F(EventReportTest, IsYellowOrRedByACertainLoss) {
  report_.shaking.stiffness[1].after.value = 900;
  EXPECT_EQ(verdict().color, EventColor::yellow);
  EXPECT_NE(verdict().reasons.front().find("frame y2 of story 1 (kx_1_y2) lost 10.0 %"),
            std::string::npos)
      << verdict().reasons.front();
  report_.shaking.stiffness[1].after.std_error = 50;
  EXPECT_EQ(verdict().color, EventColor::green);
  report_.shaking.stiffness[1].after = {700, 10, 3};
  EXPECT_EQ(verdict().color, EventColor::red);
}

TEST_F(EventReportTest, IsNotGreenIfADriftIsUnknown) {
  for (double& drift : report_.shaking.peak.drift_m) drift = estimator::kNaN;
  EXPECT_EQ(verdict().color, EventColor::yellow);
  EXPECT_NE(verdict().reasons.front().find("not known"), std::string::npos);
}

TEST_F(EventReportTest, SaysWhenNoStiffnessCouldBeCompared) {
  for (estimator::ShakenStiffness& k : report_.shaking.stiffness) k = {};
  EXPECT_EQ(verdict().color, EventColor::green);
  EXPECT_NE(verdict().reasons.back().find("no stiffness could be compared"), std::string::npos);
}

TEST_F(EventReportTest, PageAndJsonAgree) {
  report_.shaking.peak.drift_m[0] = 0.006;
  report_.shaking.peak.base_shear_n = {1234, estimator::kNaN};
  event_t finding{};
  finding.message = "<script>";
  report_.findings = {finding};
  const std::string html = event_report_html(report_, *config_);
  EXPECT_LT(html.find("Yellow: story 1 drifted by 0.60 %"), html.find("<h1>"));
  EXPECT_EQ(html.find("<script>"), std::string::npos);
  const auto json = nlohmann::json::parse(event_report_json(report_, *config_));
  EXPECT_EQ(json["schema"], "framewatch.event_report/1");
  EXPECT_EQ(json["verdict"], "yellow");
  EXPECT_NEAR(json["stories"][0]["peak_drift_ratio"].get<double>(), 0.006, 1e-12);
  EXPECT_NEAR(json["base_shear_n"]["x"].get<double>(), 1234, 1e-9);
  EXPECT_TRUE(json["base_shear_n"]["y"].is_null());
  EXPECT_NE(html.find("Peak base shear: 1.23 kN along x, not known along y."), std::string::npos);
  EXPECT_EQ(json["stiffness"][0]["before_from"], "windows_before");
  EXPECT_EQ(json["sensors"].size(), config_->pipeline.axes.size());
}

TEST_F(EventReportTest, RemovesOnlyTheOldestFiles) {
  const std::string folder = config_->event_report->directory;
  {
    EventReportFiles files;
    files.write(report_, *config_);
  }
  test::write_file(folder + "/event-notes.json", "mine");
  for (int i = 1; i <= 4; ++i) {
    report_.shaking.start += std::chrono::seconds(60);
    EXPECT_EQ(write_event_report(report_, *config_, folder), "");
  }
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  ASSERT_EQ(names.size(), 7u);
  EXPECT_EQ(names.front(), "event-20261124T004828Z.html");
  EXPECT_EQ(names.back(), "event-notes.json");
}

TEST_F(EventReportTest, ReportsAFolderThatItCannotCreate) {
  test::write_file(directory_.path("file"), "");
  EXPECT_NE(write_event_report(report_, *config_, directory_.path("file/reports")), "");
}

TEST(EventReportConfig, RefusesThresholdsThatDoNotAscend) {
  test::TemporaryDirectory directory;
  test::write_file(directory.path("b.toml"),
                   test::read_file(test::table_config()) +
                       "\n[event_report]\ndirectory = \"r\"\nred_drift_ratio = 0.001\n");
  std::vector<ConfigProblem> problems;
  EXPECT_FALSE(load_config(directory.path("b.toml"), problems));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].message.find("must not be below yellow_drift_ratio"), std::string::npos);
}

}  // namespace event_report_test
}  // namespace framewatch::daemon
