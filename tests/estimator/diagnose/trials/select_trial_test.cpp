// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/select_trial.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/diagnose/trials/trials.h"
#include "tests/estimator/diagnose/hand_made_trials.h"

namespace framewatch::estimator {
namespace select_trial_test {

using test::HandMade;

// Shares of the excess that a trial must explain.
constexpr double kMax = 0.97, kMaxWhereChanceIsLeft = 0.9, kNear = 0.005;
constexpr double kExcess = 4000, kNeeded = 100;
constexpr double kWorse = 1.02;  // misfit of a record, relative

/// A model with an excess of kExcess. Trials without theta cannot be refitted and stay as they are
/// made.
struct Excess {
  HandMade made;
  double bound;

  Excess() {
    made.now.cost = 10 * kExcess;
    bound = made.now.cost - kExcess;
  }

  Trial with_share(double share, EffectKind kind = EffectKind::extra_mass) const {
    Trial out = made.trial(kind, share * kExcess);
    out.model.theta.setConstant(std::nan(""));
    return out;
  }
  bool adopted(std::vector<Trial>& trials, double needed = kNeeded) const {
    return select_trial(made.context(), bound, needed, trials);
  }
};

TEST(AdoptTrials, AdoptsNoneIfNoneWasFitted) {
  const Excess excess;
  std::vector<Trial> none;
  EXPECT_FALSE(excess.adopted(none));
  std::vector<Trial> unfitted{excess.with_share(1), excess.with_share(1), excess.with_share(1)};
  unfitted[0].outcome = TrialOutcome::screened_out;
  unfitted[1].outcome = TrialOutcome::diverged;
  unfitted[2].outcome = TrialOutcome::other_law;
  EXPECT_FALSE(excess.adopted(unfitted));
}

TEST(NearestLaw, IsALawOfAnElementThatExplainsMostOfTheMisfit) {
  constexpr double kNearest = 0.8;
  HandMade made;
  made.now.misfit[0] += kExcess;
  made.now.cost += kExcess;
  const double beyond = made.now.total_misfit() - made.recorded.fitter.expected(made.now.model);
  const auto nearest = [&](double share, LawForm form, double of_record = 1) {
    Trial trial = made.trial(EffectKind::cubic_stiffness, share * beyond);
    trial.model.effects.emplace_back();
    trial.model.effects.back().form = form;
    trial.misfit[0] *= of_record;
    return is_nearest_law(made.context(), trial);
  };
  EXPECT_TRUE(nearest(kNearest + kNear, LawForm::power));
  EXPECT_FALSE(nearest(kNearest - kNear, LawForm::power));
  EXPECT_FALSE(nearest(kNearest + kNear, LawForm::damper)) << "has no shape";
  EXPECT_FALSE(nearest(kNearest + kNear, LawForm::power, 2)) << "a record gets worse";
  EXPECT_FALSE(is_nearest_law(made.context(), made.trial(EffectKind::gain_error, kExcess)));
}

TEST(AdoptTrials, OrdersBestFirstAndUnfittedLast) {
  const Excess excess;
  std::vector<Trial> trials;
  for (const double share : {0.2, 0.99, 0.98, 0.5}) trials.push_back(excess.with_share(share));
  trials[1].outcome = TrialOutcome::diverged;
  excess.adopted(trials);
  const double order[] = {0.98, 0.5, 0.2, 0.99};
  for (std::size_t i = 0; i < trials.size(); ++i)
    EXPECT_NEAR(trials[i].fraction, order[i], 1e-9) << i;
  EXPECT_EQ(trials.back().outcome, TrialOutcome::diverged);
}

TEST(AdoptTrials, AdoptsALawThatExplainsMostOfTheExcess) {
  struct Share {
    double share, needed;
    bool adopted;
  };
  const double left = (1 - kMaxWhereChanceIsLeft) * kExcess;
  const Share all[] = {
      {kMax + kNear, kNeeded, true},
      {kMax - kNear, kNeeded, false},
      // The rest is within chance, so a smaller share suffices.
      {kMax - kNear, left, true},
      {kMaxWhereChanceIsLeft + kNear, left, true},
      {kMaxWhereChanceIsLeft - kNear, 2 * left, false},
      {1.2, kNeeded, true},
      {-0.2, kNeeded, false},
  };
  for (const Share& s : all) {
    const Excess excess;
    std::vector<Trial> trials{excess.with_share(s.share)};
    EXPECT_EQ(excess.adopted(trials, s.needed), s.adopted) << s.share << " " << s.needed;
  }
}

TEST(AdoptTrials, AdoptsNoGainWithinChance) {
  const Excess excess;
  std::vector<Trial> trials{excess.with_share(1)};
  EXPECT_FALSE(excess.adopted(trials, 1.01 * kExcess));
  EXPECT_TRUE(excess.adopted(trials, 0.99 * kExcess));
}

TEST(AdoptTrials, AdoptsNothingThatMakesARecordWorse) {
  const Excess excess;
  const double record = excess.made.now.misfit[0];
  for (const double near : {-1.0, 1.0}) {
    std::vector<Trial> trials{excess.with_share(1)};
    trials[0].misfit[0] = kWorse * record + kNeeded + near;
    EXPECT_EQ(worsens(excess.made.recorded.fitter, trials[0], excess.made.now, kNeeded), near > 0);
    EXPECT_EQ(excess.adopted(trials), near < 0);
  }
}

TEST(AdoptTrials, TwoEffectsMustBeatOneByMoreThanChance) {
  for (const double better : {0.5 * kNeeded, 1.5 * kNeeded}) {
    const Excess excess;
    std::vector<Trial> trials{excess.with_share(0.98), excess.with_share(0.98 + better / kExcess)};
    trials[1].second = std::pair(EffectKind::gain_error, test::at_channel(0));
    excess.adopted(trials);
    EXPECT_EQ(trials[0].second.has_value(), better > kNeeded) << better;
  }
}

TEST(AdoptTrials, EveryFittedValueHasACost) {
  const Excess excess;
  const double of_value =
      0.5 * std::log(excess.made.recorded.fitter.expected(excess.made.now.model));
  constexpr int kValues = 4;
  for (const double beside : {-0.1, 0.1}) {
    Trial plain = excess.with_share(0.98);
    Trial rich = excess.with_share(0.98);
    rich.cost -= kValues * of_value + beside;
    rich.kind = EffectKind::pinching;
    ModelEffect effect;
    effect.form = LawForm::mass;
    effect.place = test::at_crossing(1);
    effect.parameters.assign(kValues + 2, linear_parameter(1, 1));
    effect.parameters[0].free = effect.parameters[1].free = false;
    rich.model.effects.push_back(effect);
    std::vector<Trial> trials{plain, rich};
    excess.adopted(trials);
    EXPECT_EQ(trials[0].kind == EffectKind::pinching, beside > 0) << beside;
  }
}

TEST(AdoptTrials, PrefersALawToAFreeForce) {
  const Excess excess;
  Trial any = excess.with_share(1, EffectKind::unmeasured_force);
  ModelEffect effect;
  effect.form = LawForm::broadband;
  effect.place = test::at_node(2);
  any.model.effects.push_back(effect);
  std::vector<Trial> trials{any, excess.with_share(0.975)};
  excess.adopted(trials);
  EXPECT_EQ(trials[0].kind, EffectKind::extra_mass);
  trials = {any, excess.with_share(0.9)};
  excess.adopted(trials);
  EXPECT_EQ(trials[0].kind, EffectKind::unmeasured_force);
}

TEST(AdoptTrials, RefinesACoarseFitUnlessItIsHopeless) {
  // A hidden mass, in a trial with half of it, and in a trial far behind.
  constexpr double kMass_kg = 6000, kOff = 0.1;
  HandMade made(test::records_with(
      {test::effect_of(EffectKind::extra_mass, test::at_crossing(1), {kMass_kg})}));
  Trial half = made.trial(EffectKind::extra_mass, 0);
  ModelEffect mass;
  mass.form = LawForm::mass;
  mass.place = test::at_crossing(1);
  mass.parameters = {linear_parameter(0.5 * kMass_kg, 100)};
  half.model.effects.push_back(mass);
  FitOptions stay;
  stay.max_steps = 0;
  const FitResult begun = made.recorded.fitter.fit(half.model, {}, stay);
  const double expected = made.recorded.fitter.expected(made.now.model);
  made.now.cost = 10 * begun.cost;  // the trial explains most of it
  half.cost = begun.cost;
  half.misfit = begun.misfit;
  Trial hopeless = half;
  hopeless.cost = 4.2 * begun.cost;
  std::vector<Trial> trials{half, hopeless};
  select_trial(made.context(), 0.8 * expected, kNeeded, trials);
  EXPECT_LT(trials[0].cost, begun.cost);
  EXPECT_EQ(trials[1].cost, hopeless.cost);
  EXPECT_NEAR(trials[0].model.effects.back().parameters[0].plain() / kMass_kg, 1, kOff);
}

constexpr double kSure = 0.9;

/// A cubic spring, and the laws tried at its place.
struct Tried {
  test::HandMade made{test::records_with(
      {test::effect_of(EffectKind::cubic_stiffness, test::in_frame(1), {1e10})}, {1, 2})};
  std::vector<Trial> trials = try_places(made.context(), {made.recorded.freed(test::in_frame(1))});

  /// Returns the effect found under the first name that is cubic or not, with the others as
  /// alternatives.
  FoundEffect found(bool cubic) {
    const auto chosen = std::find_if(trials.begin(), trials.end(), [&](const Trial& t) {
      return t.outcome == TrialOutcome::fitted && !t.model.effects.empty() &&
             t.model.effects.back().element_law() &&
             (t.kind == EffectKind::cubic_stiffness) == cubic;
    });
    FoundEffect out;
    out.chosen = *chosen;
    out.alternatives = trials;
    out.confidence = 0.99;
    out.index = 0;
    made.now = made.recorded.fitter.fit(chosen->model, {}, thorough(chosen->model, 0));
    return out;
  }
};

TEST(ReplacementLaw, TheBetterLawIsChosen) {
  Tried tried;
  FoundEffect effect = tried.found(false);
  FitResult now = tried.made.now;
  const double before = now.cost;
  EXPECT_TRUE(choose_replacement(tried.made.context(), effect, now));
  EXPECT_EQ(effect.chosen.kind, EffectKind::cubic_stiffness);
  EXPECT_EQ(effect.index, 0);
  EXPECT_LT(now.cost, before);
}

TEST(ReplacementLaw, TheRightLawStaysWithHighConfidence) {
  Tried tried;
  FoundEffect effect = tried.found(true);
  FitResult now = tried.made.now;
  EXPECT_FALSE(choose_replacement(tried.made.context(), effect, now));
  EXPECT_EQ(effect.chosen.kind, EffectKind::cubic_stiffness);
  EXPECT_GT(effect.confidence, kSure);
}

}  // namespace select_trial_test

}  // namespace framewatch::estimator
