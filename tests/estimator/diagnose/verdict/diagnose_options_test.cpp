// SPDX-License-Identifier: MIT
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/diagnosis_input.h"
#include "estimator/diagnose/verdict/diagnose.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace diagnose_options_test {

constexpr double kGain = 0.08, kGainOff = 0.01;
constexpr int kChannel = 1;

/// Returns two records with one axis that reads too much.
std::vector<Eigen::MatrixXd> records_with_gain() {
  std::vector<Eigen::MatrixXd> out = test::records_with({}, {1, 2});
  for (Eigen::MatrixXd& record : out) record.col(kChannel) *= 1 + kGain;
  return out;
}

Diagnosis diagnosed(const std::vector<Eigen::MatrixXd>& records,
                    const DiagnosisOptions& options = {}) {
  const test::Small small;
  const Plant plant = small.plant();
  return diagnose(plant, small.segments(records), options);
}

TEST(DiagnoseOptions, TheNumbersOfTheSearchDecide) {
  constexpr double kSurest = 0.7;
  DiagnosisOptions options;
  options.settings.surest = kSurest;
  const Diagnosis d = diagnosed(records_with_gain(), options);
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_DOUBLE_EQ(d.effects[0].confidence, kSurest);
  EXPECT_DOUBLE_EQ(d.settings.surest, kSurest);
}

TEST(DiagnoseOptions, NeverGivesAnExcludedName) {
  DiagnosisOptions options;
  options.without = {EffectKind::gain_error};
  const Diagnosis d = diagnosed(records_with_gain(), options);
  EXPECT_NE(d.verdict, Verdict::adequate);
  for (const FoundEffect& f : d.effects) EXPECT_NE(f.chosen.kind, EffectKind::gain_error);
  for (const Trial& t : d.rejected) EXPECT_NE(t.kind, EffectKind::gain_error);
}

TEST(DiagnoseOptions, FitsAKnownEffectWithoutReportingIt) {
  DiagnosisOptions options;
  options.known = {
      test::effect_of(EffectKind::gain_error, test::at_channel(kChannel), {0.5 * kGain})};
  const Diagnosis d = diagnosed(records_with_gain(), options);
  EXPECT_EQ(d.verdict, Verdict::adequate);
  EXPECT_TRUE(d.effects.empty());
  ASSERT_EQ(d.known.size(), 1U);
  ASSERT_EQ(d.known[0].std_error.size(), 1U);
  EXPECT_NEAR(d.model.gain[kChannel], kGain, 5 * d.known[0].std_error[0] + 1e-3);
  EXPECT_NEAR(d.declared.gain[kChannel], kGain, kGainOff);
}

TEST(DiagnoseOptions, SearchesNothingWithoutRounds) {
  DiagnosisOptions options;
  options.rounds = 0;
  const Diagnosis d = diagnosed(records_with_gain(), options);
  EXPECT_EQ(d.verdict, Verdict::unexplained);
  EXPECT_TRUE(d.effects.empty());
  EXPECT_TRUE(d.where.empty());
  EXPECT_GT(d.ratio_before, 1.5);
  EXPECT_DOUBLE_EQ(d.ratio_before, d.ratio_after);
}

TEST(DiagnoseOptions, GivesTheGapOfEverySegment) {
  for (const std::size_t holdout_from : {1U, 2U}) {
    DiagnosisOptions options;
    options.holdout_from = holdout_from;
    const Diagnosis d = diagnosed(records_with_gain(), options);
    ASSERT_EQ(d.effects.size(), 1U);
    EXPECT_EQ(d.before.size(), 2U);
    EXPECT_EQ(d.after.size(), 2U);
    // The mean over no segments is 0.
    EXPECT_EQ(d.effects[0].before > 0, holdout_from < 2);
    EXPECT_EQ(d.effects[0].after > 0, holdout_from < 2);
  }
}

TEST(DiagnoseOptions, ReportsProgressInOrder) {
  DiagnosisOptions options;
  double last = 0;
  int told = 0;
  options.progress = [&](const std::string& what, double share, double then) {
    EXPECT_FALSE(what.empty());
    EXPECT_GE(share, last) << what;
    EXPECT_GE(then, share) << what;
    EXPECT_LE(then, 1) << what;
    last = share;
    ++told;
  };
  diagnosed(records_with_gain(), options);
  EXPECT_GE(told, 4);
}

TEST(DiagnoseOptions, ResultDoesNotDependOnTheOrderOfTheWork) {
  DiagnosisOptions backwards;
  backwards.parallel = [](int count, const std::function<void(int)>& work) {
    for (int i = count; i-- > 0;) work(i);
  };
  const Diagnosis a = diagnosed(records_with_gain()), b = diagnosed(records_with_gain(), backwards);
  EXPECT_EQ(a.model.theta, b.model.theta);
  EXPECT_EQ(a.model.gain, b.model.gain);
  EXPECT_EQ(a.verdict, b.verdict);
  ASSERT_EQ(a.map.size(), b.map.size());
  for (std::size_t i = 0; i < a.map.size(); ++i) EXPECT_EQ(a.map[i].place, b.map[i].place);
}

TEST(Diagnose, IsUnexplainedWithoutSegments) {
  const Diagnosis d = diagnosed({});
  EXPECT_EQ(d.verdict, Verdict::unexplained);
  EXPECT_NE(d.reason.find("cannot be fitted"), std::string::npos);
  EXPECT_TRUE(d.effects.empty());
  EXPECT_EQ(fitted_linear(test::Small().plant(), {}, {}).size(), 0);
}

TEST(Diagnose, NeverExplainsANanReading) {
  std::vector<Eigen::MatrixXd> records = test::records_with({}, {1});
  records[0](300, kChannel) = std::numeric_limits<double>::quiet_NaN();
  const Diagnosis d = diagnosed(records);
  EXPECT_EQ(d.verdict, Verdict::unexplained);
  EXPECT_TRUE(d.effects.empty());
}

TEST(Diagnose, LinearFitMatchesTheBuilding) {
  constexpr double kOff = 0.02;
  const test::Recorded recorded(test::records_with({}));
  const Eigen::VectorXd theta = fitted_linear(recorded.plant, recorded.segments, {});
  ASSERT_EQ(theta.size(), recorded.plant.design.size());
  for (int f = 0; f < 4; ++f) EXPECT_NEAR(theta[f] / recorded.small.truth[f], 1, kOff);
}

}  // namespace diagnose_options_test
}  // namespace framewatch::estimator
