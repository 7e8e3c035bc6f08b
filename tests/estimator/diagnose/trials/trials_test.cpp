// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/trials.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/diagnose/trials/refit.h"
#include "estimator/diagnose/trials/round_trials.h"
#include "tests/estimator/diagnose/hand_made_trials.h"

namespace framewatch::estimator {
namespace trials_test {

using test::HandMade;

constexpr double kGain = 0.2, kGainOff = 0.01;

Localisation freed_pair(const HandMade& made, const EffectPlace& a, const EffectPlace& b) {
  std::vector<CandidatePlace> both;
  for (const EffectPlace& place : {a, b})
    both.push_back(made.recorded.freed(place).candidate_places.front());
  return localise(made.recorded.fitter, made.now.model, {}, both, 6);
}

const Trial& cheapest(const std::vector<Trial>& trials) {
  return *std::min_element(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) {
    return (a.outcome != TrialOutcome::fitted ? 1e300 : a.cost) <
           (b.outcome != TrialOutcome::fitted ? 1e300 : b.cost);
  });
}

TEST(Trials, FitTheErrorOfAReadingToConvergence) {
  std::vector<Eigen::MatrixXd> records = test::records_with({});
  records[0].col(1) *= 1 + kGain;
  const HandMade made(records);
  const std::vector<Trial> trials =
      try_places(made.context(), {made.recorded.freed(test::at_channel(1))});
  ASSERT_FALSE(trials.empty());
  const Trial& best = cheapest(trials);
  EXPECT_EQ(best.outcome, TrialOutcome::fitted);
  EXPECT_EQ(name_of(best.kind), "gain_error");
  EXPECT_NEAR(best.model.gain[1], kGain, kGainOff);
  EXPECT_LT(best.cost, made.now.cost);
  EXPECT_EQ(best.misfit.size(), 1U);
}

TEST(Trials, SkipExcludedNames) {
  HandMade made;
  made.without = {EffectKind::gain_error, EffectKind::misalignment};
  const std::vector<Trial> trials =
      try_places(made.context(), {made.recorded.freed(test::at_channel(1))});
  ASSERT_FALSE(trials.empty());
  for (const Trial& t : trials) EXPECT_EQ(name_of(t.kind), "time_shift");
}

TEST(Trials, TreatExchangedReadingsAsOneEffectOfTwoPlaces) {
  std::vector<Eigen::MatrixXd> records = test::records_with({});
  records[0].col(2).swap(records[0].col(1));
  const HandMade made(records);
  const std::vector<Trial> trials =
      try_pair(made.context(), freed_pair(made, test::at_channel(2), test::at_channel(1)));
  ASSERT_FALSE(trials.empty());
  const Trial& best = cheapest(trials);
  EXPECT_EQ(name_of(best.kind), "swapped");
  EXPECT_EQ(best.place.channel, 1);
  EXPECT_EQ(best.place.with_channel, 2);
  EXPECT_FALSE(best.second.has_value());
}

TEST(Trials, TreatTwoWrongGainsAsTwoEffects) {
  std::vector<Eigen::MatrixXd> records = test::records_with({});
  records[0].col(0) *= 1 + kGain;
  records[0].col(3) *= 1 - kGain;
  const HandMade made(records);
  const std::vector<Trial> trials =
      try_pair(made.context(), freed_pair(made, test::at_channel(0), test::at_channel(3)));
  const Trial& best = cheapest(trials);
  EXPECT_EQ(name_of(best.kind), "gain_error");
  ASSERT_TRUE(best.second.has_value());
  EXPECT_EQ(name_of(best.second->first), "gain_error");
  EXPECT_NEAR(best.model.gain[0], kGain, kGainOff);
  EXPECT_NEAR(best.model.gain[3], -kGain, kGainOff);
  EXPECT_EQ(best.model.free_gain.size(), 2U);
}

TEST(Trials, FreeOnlyTheShapeOfRoundHysteresis) {
  constexpr double kRound = 2, kCorner = 40;
  for (const LawForm form : {LawForm::hysteresis, LawForm::pinched, LawForm::power})
    for (const double exponent : {kRound, kCorner}) {
      Model model;
      ModelEffect e;
      e.form = form;
      for (const double value : {1e6, 1e-3, exponent, 0.5})
        e.parameters.push_back(bounded_parameter(value, 0.1, 0.1, 1e9, false));
      model.effects.push_back(e);
      free_shapes(model);
      const bool freed = form != LawForm::power && exponent == kRound;
      for (const std::size_t parameter : {2U, 3U})
        EXPECT_EQ(model.effects[0].parameters[parameter].free, freed) << exponent;
      EXPECT_FALSE(model.effects[0].parameters[0].free);
    }
}

TEST(Trials, UseTheWeakestRecordOnlyAmongSeveralWithoutTimes) {
  const HandMade one;
  EXPECT_EQ(fitted_to_the_weakest(one.context(), one.now.model).theta, one.now.model.theta);
  HandMade two(test::records_with({}, {1, 2}));
  Model changing = two.now.model;
  changing.effects.emplace_back();
  changing.effects[0].record_parameters.resize(2);
  EXPECT_EQ(fitted_to_the_weakest(two.context(), changing).theta, changing.theta);
  EXPECT_NE(fitted_to_the_weakest(two.context(), two.now.model).theta, two.now.model.theta);
}

TEST(Trials, RefiningATrialNeverMakesItWorse) {
  const HandMade made;
  const Trial fitted = made.trial(EffectKind::gain_error, 0);
  EXPECT_LE(refined(made.context(), fitted, fitted.model).cost, fitted.cost);
  Model far = made.now.model;
  far.theta *= 1.1;
  const Trial poor = made.trial(EffectKind::gain_error, -1e6);
  EXPECT_LT(refined(made.context(), poor, far).cost, made.now.cost + 1);
}

TEST(RoundTrials, TheBoundIsTheMisfitOfAllEquations) {
  const HandMade made;
  const double equations = static_cast<double>(made.recorded.plant.equations());
  Localisation place = made.recorded.freed(test::in_frame(2));
  EXPECT_TRUE(is_element(place));
  place.misfit = 300;
  EXPECT_DOUBLE_EQ(bound_of(made.recorded.plant, place), 300 * equations / (equations - 1));
  const Localisation axis = made.recorded.freed(test::at_channel(1));
  EXPECT_FALSE(is_element(axis));
  // Two forces at a crossing and a reading: one equation is left.
  Localisation most = made.recorded.freed(test::at_crossing(1));
  most.misfit = 300;
  most.candidate_places.push_back(axis.candidate_places.front());
  EXPECT_DOUBLE_EQ(bound_of(made.recorded.plant, most), 300 * equations / (equations - 3));
}

}  // namespace trials_test
}  // namespace framewatch::estimator
