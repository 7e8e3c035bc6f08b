// SPDX-License-Identifier: MIT
// Tests drift, damage and placard: one computation, shown in words, as a page and as JSON.
#include "daemon/monitor/event_report/drift_report.h"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/event_report/report_words.h"
#include "estimator/numeric/nan.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace drift_report_test {

/// The two-story table with stories of 1 m and with peaks whose slow part and stiffness are known.
class DriftReportTest : public testing::Test {
 protected:
  DriftReportTest() : config_(*read(kFragility)) {
    const auto dofs = static_cast<std::size_t>(config_.pipeline.structure.degrees_of_freedom());
    peak_ = {config_.pipeline.axes.size(), dofs};
    peak_.accel_mps2.assign(config_.pipeline.axes.size(), 1.5);
    peak_.drift_m.assign(dofs, 0.001);
    peak_.slow_m.assign(dofs, 0.00005);
    const estimator::ParameterTable table = config_.pipeline.parameters();
    known_.theta.assign(static_cast<std::size_t>(table.size()), 1e6);
    known_.std_error.assign(known_.theta.size(), 0.01);
    known_.misfit = 0.01;
  }
  static std::optional<Config> read(const std::string& section) {
    std::vector<ConfigProblem> problems;
    auto out = parse_config("b.toml", test::read_file(test::table_config()) + section, problems);
    EXPECT_TRUE(out) << (problems.empty() ? "" : problems.front().message);
    return out;
  }
  DriftReport report(const std::string& loss = "") const {
    return drift_report(config_, config_.pipeline, peak_, known_, loss);
  }

  static constexpr const char* kFragility =
      "\n[fragility]\ntype = \"C1\"\ndesign_level = \"high\"\n";
  Config config_;
  estimator::PeakResponse peak_;
  estimator::DriftKnowledge known_;
};

TEST_F(DriftReportTest, GivesThePlacardWithItsReason) {
  const DriftReport quiet = report();
  ASSERT_TRUE(quiet.placard);
  EXPECT_EQ(placard_words(*quiet.placard), "inspected");
  EXPECT_NE(quiet.reason.find("less than 1 % likely"), std::string::npos) << quiet.reason;
  peak_.drift_m[0] = 0.03;
  const DriftReport strong = report();
  EXPECT_EQ(placard_words(*strong.placard), "unsafe");
  EXPECT_EQ(strong.reason.find("Story 1 drifted 3.0"), 0u) << strong.reason;
  EXPECT_NE(strong.reason.find(" ± "), std::string::npos);
  EXPECT_NE(strong.reason.find("extensive or worse damage is 50 % likely"), std::string::npos);
}

TEST_F(DriftReportTest, NeverSaysInspectedWithALastingLoss) {
  const DriftReport r = report("frame y1 of story 1 lost 12.0 % of its stiffness");
  EXPECT_EQ(r.placard->placard, estimator::Placard::restricted);
  EXPECT_EQ(r.reason.find("Frame y1 of story 1 lost 12.0 %"), 0u) << r.reason;
}

TEST_F(DriftReportTest, IsNotJudgedIfADriftIsUnknown) {
  for (double& drift : peak_.drift_m) drift = estimator::kNaN;
  const DriftReport r = report();
  EXPECT_EQ(placard_words(*r.placard), "restricted use (not judged)");
  EXPECT_NE(r.reason.find("the drift of story 1 is not known"), std::string::npos);
  const auto json = nlohmann::json::parse(drifts_json(r, config_));
  EXPECT_TRUE(json["stories"][0]["peak_drift_ratio"].is_null());
  EXPECT_TRUE(json["stories"][0]["probability_or_worse"]["slight"].is_null());
  EXPECT_EQ(json["placard"]["because"], "drift_unknown");
}

TEST_F(DriftReportTest, IsNotJudgedWithAGapAtThePeak) {
  peak_.unseen_mps2[0] = 1.2;
  const DriftReport r = report();
  EXPECT_EQ(placard_words(*r.placard), "restricted use (not judged)");
  EXPECT_NE(r.reason.find("drift of story 1 is unknown in part"), std::string::npos) << r.reason;
}

TEST_F(DriftReportTest, WithoutFragilityGivesOnlyDrifts) {
  config_.fragility.reset();
  const DriftReport r = report();
  EXPECT_FALSE(r.placard);
  EXPECT_EQ(placard_section(r), "");
  const std::string html = drift_table_section(r, config_);
  EXPECT_NE(html.find("No fragility is configured"), std::string::npos);
  EXPECT_EQ(html.find("or worse"), std::string::npos);
  const auto json = nlohmann::json::parse(drifts_json(r, config_));
  EXPECT_TRUE(json["placard"].is_null());
  EXPECT_TRUE(json["fragility"].is_null());
  EXPECT_GT(json["stories"][0]["std_error_ratio"].get<double>(), 0);
}

TEST_F(DriftReportTest, PageAndJsonAgree) {
  peak_.drift_m[0] = 0.012;
  const DriftReport r = report();
  const std::string page = placard_section(r) + drift_table_section(r, config_);
  EXPECT_NE(page.find("Placard: restricted use. Story 1 drifted 1.2"), std::string::npos);
  EXPECT_NE(page.find(placard_caution()), std::string::npos);
  EXPECT_NE(page.find("Permanent drift is in none of the numbers"), std::string::npos);
  EXPECT_NE(page.find("Probabilities by HAZUS C1L, high code"), std::string::npos);
  const auto json = nlohmann::json::parse(drifts_json(r, config_));
  EXPECT_EQ(json["schema"], "framewatch.drifts/1");
  EXPECT_EQ(json["placard"]["placard"], "restricted_use");
  EXPECT_EQ(json["placard"]["reason"], r.reason);
  EXPECT_EQ(json["placard"]["story"], 1);
  EXPECT_NEAR(json["stories"][0]["probability_or_worse"]["moderate"].get<double>(), r.damage[0][1],
              1e-12);
  EXPECT_EQ(json["fragility"]["stories"][0]["median_drift_ratio"][1], 0.01);
}

}  // namespace drift_report_test
}  // namespace framewatch::daemon
