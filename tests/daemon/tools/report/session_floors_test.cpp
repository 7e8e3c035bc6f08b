// SPDX-License-Identifier: MIT
#include "daemon/tools/report/session_floors.h"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/tools/lab/few_sensors.h"
#include "daemon/tools/report/session_report.h"

namespace framewatch::daemon {
namespace session_floors_test {

struct Session {
  Config config;
  SessionMotion motion;
  SessionEstimates estimates;
};

/// The base and floors 2, 4 and 6 of six have channels; no parameter is identified.
Session six_stories() {
  TallTrial trial;
  trial.stories = 6;
  trial.floors = {2, 4, 6};
  trial.noise_ratio = 0;
  trial.stiffness_off = trial.damping_off = 0;
  trial.duration_s = 40;
  const TallRecord record = tall_record(trial);
  Session out;
  out.config.pipeline = record.config;
  out.motion = {record.config.options.rate_hz, 0, record.config.axes, record.accel, {}};
  const auto parameters = static_cast<std::size_t>(record.config.parameters().size());
  out.estimates.value.resize(parameters);
  out.estimates.std_error.resize(parameters);
  out.estimates.reason.resize(parameters);
  return out;
}

TEST(SessionFloors, MatchTheMotionIfTheDesignIsRight) {
  constexpr double kError = 0.01;
  const Session s = six_stories();
  const SessionFloors floors = session_floors(s.config, s.motion, s.estimates);
  EXPECT_EQ(floors.identified, std::vector<std::uint8_t>(floors.theta.size(), 0));
  ASSERT_EQ(floors.left_out.size(), 2u);
  for (const estimator::LeftOutFloor& one : floors.left_out) EXPECT_LT(one.low_error, kError);
  EXPECT_TRUE(floors.measured[4][0]);
  EXPECT_FALSE(floors.measured[3][0]);
  for (int story = 1; story <= 6; ++story)
    EXPECT_GT(peak_drift_ratio(floors, s.config.pipeline.structure, story, 0), 0);
  EXPECT_LT(floors.from_us, floors.to_us);
}

TEST(SessionFloors, TakeTheMedianOverWindowsOfStrongMotion) {
  Session s = six_stories();
  for (int w = 0; w < 5; ++w) {
    s.estimates.start_us.push_back(10'000'000 + w);
    s.estimates.end_us.push_back(15'000'000 + w);
    for (std::size_t p = 0; p < s.estimates.parameters(); ++p) {
      s.estimates.value[p].push_back(p == 0 ? 1e9 + w : std::nan(""));
      s.estimates.std_error[p].push_back(p == 0 ? 1e6 : std::nan(""));
      s.estimates.reason[p].push_back(p == 0 ? 0 : 2);
    }
  }
  const SessionFloors floors = session_floors(s.config, s.motion, s.estimates);
  EXPECT_EQ(floors.identified[0], 1);
  EXPECT_EQ(floors.identified[1], 0);
  EXPECT_DOUBLE_EQ(floors.theta[0], 1e9 + 2);
}

TEST(SessionFloors, AreWrittenAsJson) {
  const Session s = six_stories();
  const SessionFloors floors = session_floors(s.config, s.motion, s.estimates);
  const auto json = nlohmann::json::parse(floors_json(floors, s.config, s.motion));
  EXPECT_EQ(json["schema"], "framewatch.floors/1");
  ASSERT_EQ(json["floors"].size(), 7u);
  EXPECT_EQ(json["floors"][4]["x"]["measured"], true);
  EXPECT_GT(json["floors"][3]["x"]["peak_accel_mps2"], 0.1);
  EXPECT_TRUE(json["floors"][0]["x"]["peak_drift_ratio_below"].is_null());
  ASSERT_EQ(json["left_out"].size(), 2u);
  EXPECT_EQ(json["left_out"][0]["floor"], 2);
  EXPECT_LT(json["left_out"][0]["error_below_5_hz_ratio"], 0.01);
  EXPECT_EQ(json["parameters"].size(), floors.theta.size());
}

TEST(SessionFloors, AreASectionOfTheReport) {
  Session s = six_stories();
  SessionReport report;
  report.floors = session_floors(s.config, s.motion, s.estimates);
  report.config = s.config;
  report.motion = s.motion;
  const std::string html = floors_section(report);
  EXPECT_NE(html.find("Every floor"), std::string::npos);
  EXPECT_NE(html.find("computed"), std::string::npos);
  EXPECT_NE(html.find("floor 2, x"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
  report.floors.reset();
  EXPECT_EQ(floors_section(report), "");
}

}  // namespace session_floors_test
}  // namespace framewatch::daemon
