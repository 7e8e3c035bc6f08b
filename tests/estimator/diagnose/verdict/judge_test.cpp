// SPDX-License-Identifier: MIT
#include <string>

#include <gtest/gtest.h>

#include "estimator/diagnose/verdict/verdict.h"
#include "tests/estimator/diagnose/exact_record.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace judge_test {

using test::Recorded;

constexpr double kNear = 0.01;
// Gaps over their floors.
constexpr double kAtFloor = 1.15, kNearFloor = 2.5;
constexpr double kTakesAll = 0.97;  // of the misfit beyond noise

Gap gap_with(double overall, double floor = 1) {
  Gap out;
  out.overall = overall;
  out.overall_floor = floor;
  return out;
}

Verdict judged(Diagnosis d) {
  static const Recorded recorded(test::records_with({}));
  d.linear = initial_model(recorded.plant);
  judge(recorded.fitter, d);
  return d.verdict;
}

TEST(Judge, JudgesALinearBuildingWithoutEffects) {
  struct Linear {
    const char* what;
    double ratio, gap;
    bool rejected;
    Verdict verdict;
  };
  const Linear all[] = {
      {"as good as noise", 1, 1, false, Verdict::adequate},
      {"just so", SearchSettings().adequate - kNear, 3, false, Verdict::adequate},
      {"more than noise", SearchSettings().adequate + kNear, 3, false, Verdict::unexplained},
      {"more, but its gap is at its floor", 3, kAtFloor - kNear, false, Verdict::adequate},
      {"more, and its gap above it", 3, kAtFloor + kNear, false, Verdict::unexplained},
      {"a law was tried, the gap is small", 1, kNearFloor - kNear, true, Verdict::adequate},
      {"a law was tried, the gap is large", 1, kNearFloor + kNear, true, Verdict::unexplained},
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
      {"nothing is left", 101, SearchSettings().adequate - kNear, 4, Verdict::explained},
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

TEST(Judge, DoesNotDivideByAZeroFloor) {
  Diagnosis d;
  d.ratio_before = d.ratio_after = 3;
  d.before = d.after = {gap_with(0, 0)};
  EXPECT_EQ(judged(d), Verdict::adequate);
  d.before = d.after = {gap_with(1, 0)};
  EXPECT_EQ(judged(d), Verdict::unexplained);
}

TEST(Judge, CallsRecordsThatFitOnlySeparatelyDifferentBuildings) {
  test::Small other;
  other.truth.head(4) *= 1.3;
  const Recorded recorded({test::Small().record({}, 1), other.record({}, 2)});
  const FitResult fit = recorded.linear();
  Diagnosis d;
  d.linear = fit.model;
  d.ratio_before = d.ratio_after = fit.total_misfit() / recorded.fitter.expected(fit.model);
  ASSERT_GT(d.ratio_before, SearchSettings().adequate);
  d.before = d.after = {gap_with(9)};
  judge(recorded.fitter, d);
  EXPECT_EQ(d.verdict, Verdict::unexplained);
  EXPECT_NE(d.reason.find("different buildings"), std::string::npos);
  // An earlier reason is kept.
  d.reason = "known";
  judge(recorded.fitter, d);
  EXPECT_EQ(d.reason, "known");
}

TEST(Judge, AnApproximateLinearEffectExplainsOnlyPart) {
  Diagnosis d;
  d.ratio_before = 101;
  d.ratio_after = 1.2;
  d.before = {gap_with(10)};
  d.after = {gap_with(1)};
  d.effects.emplace_back();
  d.effects[0].index = 0;
  d.model.effects.emplace_back();
  d.model.effects[0].form = LawForm::resonator;
  EXPECT_EQ(judged(d), Verdict::explained);
  d.effects[0].approximate = true;
  EXPECT_EQ(judged(d), Verdict::partly_explained);
  // The fitted shape of a law need not be that of its name.
  d.model.effects[0].form = LawForm::hysteresis;
  EXPECT_EQ(judged(d), Verdict::explained);
}

TEST(Judge, DoubtsANameOnlyIfMisfitAndGapBothLeaveSomething) {
  const Recorded recorded({test::Small().record({}, 1)});
  const FitResult fit = recorded.linear();
  struct Left {
    const char* what;
    double ratio, gap;
    bool by_place, doubted;
  };
  const Left all[] = {
      {"only noise", 1, 1, false, false},
      {"a misfit in strong motion", 1.5, kAtFloor - kNear, false, false},
      {"a gap that the misfit does not see", 1, kAtFloor + kNear, false, false},
      {"both", 1.5, kAtFloor + kNear, false, true},
      {"noise that was estimated at one place, and a gap", 1, kAtFloor + kNear, true, true},
      {"such noise at the floor", 1, kAtFloor - kNear, true, false},
  };
  for (const Left& l : all) {
    Diagnosis d;
    d.model = fit.model;
    d.ratio_after = l.ratio;
    d.noise_by_place = l.by_place;
    d.after = {gap_with(1), gap_with(l.gap)};
    d.effects.resize(2);
    for (FoundEffect& e : d.effects) e.confidence = 0.99;
    d.effects[0].ramp_mps3 = {1e-3};
    mark_approximate(recorded.fitter, d);
    EXPECT_EQ(d.effects[1].approximate, l.doubted) << l.what;
    EXPECT_EQ(d.effects[1].confidence, l.doubted ? kDoubtful : 0.99) << l.what;
    EXPECT_FALSE(d.effects[0].approximate) << "a ramp is subtracted as it was measured";
  }
}

TEST(Judge, AnArbitraryForceExplainsNothing) {
  Diagnosis d;
  d.ratio_before = 101;
  d.ratio_after = 1;
  d.before = {gap_with(10)};
  d.after = {gap_with(1)};
  d.effects.emplace_back();
  d.effects[0].index = 0;
  d.model.effects.emplace_back();
  EXPECT_EQ(judged(d), Verdict::explained);
  d.effects[0].nearest = true;
  EXPECT_EQ(judged(d), Verdict::partly_explained) << "of no law that is only near";
  d.effects[0].nearest = false;
  d.model.effects[0].form = LawForm::broadband;
  EXPECT_EQ(judged(d), Verdict::partly_explained);
}

TEST(Withdraw, RemovesNamesWhoseModelIsWorse) {
  struct Found {
    const char* what;
    double before, after, held_before, held_after;
    bool withdrawn;
  };
  const Found all[] = {
      {"better", .5, .1, .5, .2, false},
      {"as good, within chance", .5, .1, .01, .0105, false},
      {"worse where it is held out", .5, .1, .2, .23, true},
      {"beyond 100 % in a record that it was fitted to", 1.2, 1.1, .5, .2, true},
  };
  for (const Found& f : all) {
    Diagnosis d;
    d.before = {gap_with(f.before), gap_with(f.held_before)};
    d.after = {gap_with(f.after), gap_with(f.held_after)};
    d.ratio_before = 9;
    d.ratio_after = 2;
    d.effects.emplace_back();
    EXPECT_EQ(withdraw_worse({}, 1, d), f.withdrawn) << f.what;
    EXPECT_EQ(d.effects.empty(), f.withdrawn) << f.what;
    EXPECT_EQ(d.rejected.size(), f.withdrawn ? 1U : 0U) << f.what;
    EXPECT_EQ(d.reason.empty(), !f.withdrawn) << f.what;
    EXPECT_DOUBLE_EQ(d.after[1].overall, f.withdrawn ? f.held_before : f.held_after) << f.what;
    EXPECT_DOUBLE_EQ(d.ratio_after, f.withdrawn ? 9 : 2) << f.what;
  }
  Diagnosis none;
  EXPECT_FALSE(withdraw_worse({}, 1, none));
}

/// The gap of a diverging run is missing; the mean of the others must not count as a good gap.
TEST(Withdraw, RemovesEffectsThatMakeAnyRunDiverge) {
  Diagnosis d;
  d.before.resize(2);
  d.after.resize(1);
  for (Gap& g : d.before) g.overall = 0.5;
  d.after[0].overall = 0.1;
  d.effects.emplace_back();
  EXPECT_TRUE(withdraw_worse({}, 1, d));
  EXPECT_TRUE(d.effects.empty());
  EXPECT_EQ(d.after.size(), 2U);
}

TEST(Withdraw, RemovesALawThatLeavesMuchAndShowsAnotherKind) {
  constexpr double kFloor = 0.01;
  enum class Seen { nothing, its_kind, another };
  struct Found {
    const char* what;
    double held_floors;  // held-out gap over its floor
    Seen seen;
    LawForm form;
    PlaceKind place;
    bool withdrawn;
  };
  const Found all[] = {
      {"not known", 2.6, Seen::nothing, LawForm::hysteresis, PlaceKind::frame, true},
      {"another kind", 2.6, Seen::another, LawForm::hysteresis, PlaceKind::frame, true},
      {"its kind", 2.6, Seen::its_kind, LawForm::hysteresis, PlaceKind::frame, false},
      {"near the floor", 2.4, Seen::nothing, LawForm::hysteresis, PlaceKind::frame, false},
      {"to the ground", 2.6, Seen::nothing, LawForm::gap_both, PlaceKind::node_pair, true},
      {"no law", 2.6, Seen::nothing, LawForm::damper, PlaceKind::node_pair, false},
      {"of all stories", 2.6, Seen::nothing, LawForm::amplitude, PlaceKind::building, false},
  };
  for (const Found& f : all) {
    Diagnosis d;
    d.before = {gap_with(0.2, kFloor), gap_with(0.2, kFloor)};
    d.after = {gap_with(0.2, kFloor), gap_with(f.held_floors * kFloor, kFloor)};
    d.model.effects.emplace_back().form = f.form;
    FoundEffect& only = d.effects.emplace_back();
    only.index = 0;
    only.chosen.kind = EffectKind::bouc_wen;
    only.chosen.place.kind = f.place;
    WhereEntry& where = d.where.emplace_back();
    where.place = only.chosen.place;
    if (f.seen != Seen::nothing)
      where.kind.emplace().kind =
          f.seen == Seen::its_kind ? LawKind::hysteretic : LawKind::dissipative;
    EXPECT_EQ(withdraw_worse({}, 1, d), f.withdrawn) << f.what;
    EXPECT_EQ(d.effects.empty(), f.withdrawn) << f.what;
  }
}

TEST(Grade, OnlyASureNameWithoutRivalsIsEstablished) {
  FoundEffect e;
  e.confidence = 0.99;
  EXPECT_EQ(grade_of(e), Grade::established);
  e.approximate = true;
  EXPECT_EQ(grade_of(e), Grade::leading);
  e.approximate = false;
  e.like = {EffectKind::bouc_wen};
  EXPECT_EQ(grade_of(e), Grade::leading);
  e.like.clear();
  e.confidence = 0.9;
  EXPECT_EQ(grade_of(e), Grade::leading);
  EXPECT_STREQ(grade_word(Grade::established), "established");
  EXPECT_STREQ(grade_word(Grade::leading), "leading");
}

/// A hardening spring and two trials: its law, and one at another frame.
TEST(Leading, IsTheLawWhoseFreeRunDisagreesLess) {
  const test::Small small;
  const test::EffectTwins twins = test::cubic_spring(2, 4e11);
  const Recorded recorded(test::records_with({twins.simulated}, {1, 2}));
  Diagnosis d;
  d.linear = d.model = recorded.linear().model;
  d.ratio_before = d.ratio_after = 100;
  set_gaps(recorded.fitter, test::held_out_from(1), d);
  const auto trial = [&](const ModelEffect& effect, LawForm form) {
    Trial t;
    t.model = test::with_effects(d.linear, {effect});
    t.model.effects[0].form = form;
    t.kind = EffectKind::cubic_stiffness;
    t.place = effect.place;
    return t;
  };
  const ModelEffect elsewhere = test::cubic_spring(0, 1e8).modelled;
  d.rejected = {trial(elsewhere, LawForm::power), trial(twins.modelled, LawForm::power),
                trial(twins.modelled, LawForm::broadband)};
  set_leading(recorded.fitter, test::held_out_from(1), d);
  ASSERT_FALSE(d.leading.empty());
  EXPECT_EQ(d.leading.front().trial.place, twins.modelled.place);
  EXPECT_LT(d.leading.front().after, 0.2 * d.leading.front().before);
  EXPECT_DOUBLE_EQ(d.leading.front().before, mean_gap(d.before, 1));
  for (const LeadingLaw& law : d.leading)
    EXPECT_NE(law.trial.model.effects[0].form, LawForm::broadband);
  // A model that fits needs no leading law, and neither does a named effect.
  d.leading.clear();
  d.ratio_after = 1;
  set_leading(recorded.fitter, test::held_out_from(1), d);
  EXPECT_TRUE(d.leading.empty());
  d.ratio_after = 100;
  d.effects.emplace_back();
  set_leading(recorded.fitter, test::held_out_from(1), d);
  EXPECT_TRUE(d.leading.empty());
}

TEST(Judge, VerdictsHaveTheWordsOfTheReport) {
  EXPECT_STREQ(verdict_word(Verdict::adequate), "adequate");
  EXPECT_STREQ(verdict_word(Verdict::explained), "explained");
  EXPECT_STREQ(verdict_word(Verdict::partly_explained), "partly_explained");
  EXPECT_STREQ(verdict_word(Verdict::unexplained), "unexplained");
}

}  // namespace judge_test
}  // namespace framewatch::estimator
