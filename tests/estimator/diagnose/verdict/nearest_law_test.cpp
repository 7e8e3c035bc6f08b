// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/nearest_law.h"

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/hand_made_trials.h"

namespace framewatch::estimator {
namespace nearest_law_test {

using test::HandMade;

constexpr double kExcess = 4000;
constexpr int kFrame = 2, kOther = 1;

/// A model with an excess of kExcess, the kind of force at one place, and laws that explain some of
/// it.
struct Left {
  HandMade made;
  std::vector<WhereEntry> where{1};
  double beyond = 0;

  explicit Left(LawKind kind) {
    made.now.misfit[0] += kExcess;
    made.now.cost += kExcess;
    beyond = made.now.total_misfit() - made.recorded.fitter.expected(made.now.model);
    where.front().place = test::in_frame(kFrame);
    where.front().kind.emplace().kind = kind;
  }

  Trial law(EffectKind kind, double share,
            const EffectPlace& place = test::in_frame(kFrame)) const {
    Trial out = made.trial(kind, share * beyond);
    out.place = place;
    out.model.effects.emplace_back();
    out.model.effects.back().form = LawForm::power;
    return out;
  }
  bool first(std::vector<Trial>& laws) const {
    return nearest_law_first(made.context(), where, laws);
  }
};

TEST(NearestLawOfAPlace, HasTheKindOfTheForceThere) {
  const Left left(LawKind::dissipative);
  std::vector<Trial> one{left.law(EffectKind::bouc_wen, 0.9)};
  EXPECT_FALSE(left.first(one)) << "remembers";
  std::vector<Trial> two{left.law(EffectKind::bouc_wen, 0.9),
                         left.law(EffectKind::cubic_stiffness, 0.88),
                         left.law(EffectKind::quadratic_damping, 0.85)};
  ASSERT_TRUE(left.first(two));
  EXPECT_EQ(two[0].kind, EffectKind::quadratic_damping);
  EXPECT_EQ(two[1].kind, EffectKind::bouc_wen) << "the others stay in their order";
  EXPECT_EQ(two[2].kind, EffectKind::cubic_stiffness);
}

TEST(NearestLawOfAPlace, TakesMostOfTheMisfit) {
  const Left left(LawKind::hysteretic);
  std::vector<Trial> little{left.law(EffectKind::bouc_wen, 0.5)};
  EXPECT_FALSE(left.first(little));
}

TEST(NearestLawOfAPlace, ActsWhereTheKindIsKnown) {
  Left left(LawKind::elastic);
  EffectPlace whole = test::in_frame(kFrame);
  whole.kind = PlaceKind::whole_frame;
  std::vector<Trial> elsewhere{left.law(EffectKind::cubic_stiffness, 0.9, test::in_frame(kOther))};
  std::vector<Trial> all{left.law(EffectKind::amplitude_dependence, 0.9, whole)};
  std::vector<Trial> there{left.law(EffectKind::cubic_stiffness, 0.9)};
  EXPECT_FALSE(left.first(elsewhere));
  EXPECT_FALSE(left.first(all)) << "it is known of one story";
  EXPECT_TRUE(left.first(there));
  left.where.front().kind.reset();
  EXPECT_FALSE(left.first(there));
}

TEST(NearestLawOfAPlace, MayBeAnyFunctionOfTheDeformationIfItHolds) {
  const Left elastic(LawKind::elastic), impact(LawKind::impact), other(LawKind::hysteretic);
  std::vector<Trial> gap{elastic.law(EffectKind::two_sided_gap, 0.9)};
  const Trial spring = impact.law(EffectKind::cubic_stiffness, 0.98);
  EXPECT_TRUE(is_of_the_kind_there({}, gap[0], elastic.where));
  EXPECT_TRUE(is_of_the_kind_there({}, spring, impact.where));
  EXPECT_FALSE(is_of_the_kind_there({}, spring, other.where));
  EXPECT_FALSE(elastic.first(gap)) << "it does not hold, and is of another sort";
}

/// Friction that sticks is not a function of the measured motion.
TEST(NearestLawOfAPlace, MayBeOfAnotherKindIfItLeavesFarLess) {
  Left left(LawKind::external);
  left.where.front().kind->share[static_cast<std::size_t>(LawKind::hysteretic)] = 0.2;
  std::vector<Trial> most{left.law(EffectKind::coulomb_friction, 0.95)};
  std::vector<Trial> less{left.law(EffectKind::coulomb_friction, 0.9)};
  most[0].fraction = 0.95;
  less[0].fraction = 0.9;
  EXPECT_TRUE(left.first(most));
  EXPECT_TRUE(is_of_the_kind_there({}, most[0], left.where));
  EXPECT_FALSE(left.first(less));
  EXPECT_FALSE(is_of_the_kind_there({}, less[0], left.where));
  EXPECT_FALSE(is_of_the_kind_there({}, most[0], {}));
}

TEST(NearestLawOfAPlace, IsRefutedByAForceOfAnotherKind) {
  struct Said {
    LawKind kind;
    EffectKind law;
    bool contradicted;
  };
  const Said all[] = {
      {LawKind::elastic, EffectKind::bouc_wen, true},
      {LawKind::elastic, EffectKind::cubic_stiffness, false},
      {LawKind::elastic, EffectKind::two_sided_gap, false},  // both of the deformation
      {LawKind::impact, EffectKind::cubic_stiffness, false},
      {LawKind::impact, EffectKind::coulomb_friction, true},
      {LawKind::elastic, EffectKind::amplitude_dependence, false},
      {LawKind::hysteretic, EffectKind::amplitude_dependence, false},  // by slip
      {LawKind::dissipative, EffectKind::bouc_wen, true},
      {LawKind::hysteretic, EffectKind::coulomb_friction, false},
      {LawKind::hysteretic, EffectKind::quadratic_stiffness, true},
      {LawKind::time_varying, EffectKind::stiffness_drift, false},
      {LawKind::hysteretic, EffectKind::stiffness_drop, true},
      {LawKind::external, EffectKind::one_sided_gap, false},   // unknown kind
      {LawKind::hysteretic, EffectKind::added_damper, false},  // not an element law
  };
  for (const Said& said : all) {
    Left left(said.kind);
    const Trial there = left.law(said.law, 1);
    EXPECT_EQ(contradicts_the_kind({}, there, left.where), said.contradicted)
        << law_kind_word(said.kind) << " " << describe(said.law).name;
    EXPECT_FALSE(
        contradicts_the_kind({}, left.law(said.law, 1, test::in_frame(kOther)), left.where));
    left.where.front().kind.reset();
    EXPECT_FALSE(contradicts_the_kind({}, there, left.where));
  }
}

TEST(NearestLawOfAPlace, MustLeaveFarLessIfTheKindIsUncertain) {
  Left left(LawKind::elastic);
  left.where.front().kind->share[static_cast<std::size_t>(LawKind::elastic)] = 0.8;
  const Trial loop = left.law(EffectKind::pinching, 1);
  EXPECT_TRUE(contradicts_the_kind({}, loop, left.where, 0.05));
  EXPECT_FALSE(contradicts_the_kind({}, loop, left.where, 0.01));
}

TEST(NearestLawOfAPlace, AnExternalForceIsRefutedByOneThatFollowsTheMotion) {
  for (const auto& [kind, contradicted] : {std::pair(LawKind::time_varying, true),
                                           {LawKind::external, false},
                                           {LawKind::linear, false}}) {
    Left left(kind);
    Trial force = left.law(EffectKind::unmeasured_force, 1, test::at_node(kOther));
    force.model.effects.back().form = LawForm::harmonic;
    EXPECT_FALSE(contradicts_the_kind({}, force, left.where)) << "it has a frequency";
    force.model.effects.back().form = LawForm::broadband;
    EXPECT_EQ(contradicts_the_kind({}, force, left.where), contradicted) << law_kind_word(kind);
    left.where.insert(left.where.begin(), WhereEntry());
    EXPECT_FALSE(contradicts_the_kind({}, force, left.where)) << "another place is likelier";
  }
}

}  // namespace nearest_law_test
}  // namespace framewatch::estimator
