#include <string>

#include <gtest/gtest.h>

#include "estimator/diagnose/verdict/verdict.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace judge_test {

using test::Recorded;

constexpr double kNear = 0.01;
// Gaps over their floors.
constexpr double kAtFloor = 1.15, kNearFloor = 2.5, kAdequateGap = 2;
constexpr double kTakesAll = 0.97;  // of the misfit beyond noise

Gap gap_with(double overall, double floor = 1) {
  Gap out;
  out.overall = overall;
  out.overall_floor = floor;
  return out;
}

Verdict judged(Diagnosis d) {
  static const Recorded recorded(test::records_with({}));
  judge(recorded.fitter, d);
  return d.verdict;
}

TEST(Judge, WithoutEffectsALinearBuildingIsAdequateOrNot) {
  struct Linear {
    const char* what;
    double ratio, gap;
    bool rejected;
    Verdict verdict;
  };
  const Linear all[] = {
      {"as good as noise", 1, 1, false, Verdict::adequate},
      {"just so", kAdequate - kNear, 3, false, Verdict::adequate},
      {"more than noise", kAdequate + kNear, 3, false, Verdict::unexplained},
      {"more, but its gap is at its floor", 3, kAtFloor - kNear, false, Verdict::adequate},
      {"more, and its gap above it", 3, kAtFloor + kNear, false, Verdict::unexplained},
      {"a law was tried, the gap is small", 1, kAdequateGap - kNear, true, Verdict::adequate},
      {"a law was tried, the gap is large", 1, kAdequateGap + kNear, true, Verdict::unexplained},
  };
  for (const Linear& l : all) {
    Diagnosis d;
    d.ratio_before = d.ratio_after = l.ratio;
    d.before = d.after = {gap_with(1), gap_with(l.gap)};
    if (l.rejected) d.rejected.emplace_back();
    EXPECT_EQ(judged(d), l.verdict) << l.what;
  }
}

TEST(Judge, EffectsExplainAllOrPart) {
  struct Explained {
    const char* what;
    double ratio_before, ratio_after, gap;
    Verdict verdict;
  };
  const double all_but = 1 + 100 * (1 - kTakesAll);
  const Explained all[] = {
      {"nothing is left", 101, kAdequate - kNear, 4, Verdict::explained},
      {"the gap is at its floor", 101, 50, kAtFloor - kNear, Verdict::explained},
      {"nearly all, gap near its floor", 101, all_but - kNear, kNearFloor - kNear,
       Verdict::explained},
      {"nearly all, gap far from it", 101, all_but - kNear, kNearFloor + kNear,
       Verdict::partly_explained},
      {"much, gap near its floor", 101, all_but + kNear, kNearFloor - kNear,
       Verdict::partly_explained},
      {"worse than before", 2, 3, 4, Verdict::partly_explained},
  };
  for (const Explained& e : all) {
    Diagnosis d;
    d.ratio_before = e.ratio_before;
    d.ratio_after = e.ratio_after;
    d.before = {gap_with(10)};
    d.after = {gap_with(e.gap), gap_with(e.gap)};
    d.effects.emplace_back();
    EXPECT_EQ(judged(d), e.verdict) << e.what;
  }
}

TEST(Judge, NoFloorIsNoDivisionByZero) {
  Diagnosis d;
  d.ratio_before = d.ratio_after = 3;
  d.before = d.after = {gap_with(0, 0)};
  EXPECT_EQ(judged(d), Verdict::adequate);
  d.before = d.after = {gap_with(1, 0)};
  EXPECT_EQ(judged(d), Verdict::unexplained);
}

TEST(Judge, RecordsThatFitApartAreOfDifferentBuildings) {
  test::Small other;
  other.truth.head(4) *= 1.3;
  const Recorded recorded({test::Small().record({}, 1), other.record({}, 2)});
  const FitResult fit = recorded.linear();
  Diagnosis d;
  d.ratio_before = d.ratio_after = fit.total_misfit() / recorded.fitter.expected(fit.model);
  ASSERT_GT(d.ratio_before, kAdequate);
  d.before = d.after = {gap_with(9)};
  judge(recorded.fitter, d);
  EXPECT_EQ(d.verdict, Verdict::unexplained);
  EXPECT_NE(d.reason.find("different buildings"), std::string::npos);
  // A reason that is known stays.
  d.reason = "known";
  judge(recorded.fitter, d);
  EXPECT_EQ(d.reason, "known");
}

TEST(Judge, VerdictsHaveTheWordsOfTheReport) {
  EXPECT_STREQ(verdict_word(Verdict::adequate), "adequate");
  EXPECT_STREQ(verdict_word(Verdict::explained), "explained");
  EXPECT_STREQ(verdict_word(Verdict::partly_explained), "partly_explained");
  EXPECT_STREQ(verdict_word(Verdict::unexplained), "unexplained");
}

}  // namespace judge_test
}  // namespace framewatch::estimator
