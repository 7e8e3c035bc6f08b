// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/refit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/diagnose/trials/known_effects.h"
#include "estimator/diagnose/trials/trials.h"
#include "tests/estimator/diagnose/hand_made_trials.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace refit_test {

TEST(RedundantEffect, IsDetected) {
  const test::HandMade made(test::records_with(
      {test::effect_of(EffectKind::cubic_stiffness, test::in_frame(1), {1e10})}, {1, 2}));
  const std::vector<Trial> trials =
      try_places(made.context(), {made.recorded.freed(test::in_frame(1))});
  const auto cubic = std::find_if(trials.begin(), trials.end(), [](const Trial& t) {
    return t.outcome == TrialOutcome::fitted && t.kind == EffectKind::cubic_stiffness;
  });
  ASSERT_NE(cubic, trials.end());
  const Fitter& fitter = made.recorded.fitter;
  EXPECT_FALSE(is_redundant(fitter, cubic->model, made.now.model, {}));
  Model damped = cubic->model;
  ModelEffect damper;
  damper.form = LawForm::damper;
  damper.place = test::at_node(3);
  damper.parameters = {linear_parameter(0, 1e3)};
  damped.effects.push_back(damper);
  EXPECT_TRUE(is_redundant(fitter, damped, cubic->model, {}));
}

using test::Recorded;

constexpr double kGain = 0.08, kGainOff = 0.01;
constexpr double kSizeOff = 0.1;

TEST(DeclaredModel, ResetsToleratedErrors) {
  std::vector<Eigen::MatrixXd> records = test::records_with({});
  records[0].col(1) *= 1 + kGain;
  const Recorded recorded(records);
  Model start = initial_model(recorded.plant);
  const std::vector<FoundEffect> known =
      add_known(recorded.plant, recorded.segments,
                {test::effect_of(EffectKind::gain_error, test::at_channel(1), {kGain})}, start);
  Model fitted = recorded.fitter.fit(start, {}, {}).model;
  fitted.mass_change.setConstant(0.01);
  fitted.gain[0] = 0.004;
  fitted.clock_s[3] = 2e-4;
  const Model declared = declared_model(recorded.plant, recorded.segments, fitted, {&known});
  const Model none = initial_model(recorded.plant);
  EXPECT_EQ(declared.mass_change, none.mass_change);
  EXPECT_EQ(declared.clock_s, none.clock_s);
  EXPECT_DOUBLE_EQ(declared.gain[0], 0);
  // The effect's gain stays, and is fitted with the declared masses.
  EXPECT_NEAR(declared.gain[1], kGain, kGainOff);
  const Eigen::VectorXd& truth = recorded.small.truth;
  for (int f = 0; f < 4; ++f) EXPECT_NEAR(declared.theta[f] / truth[f], 1, 0.02) << f;
}

TEST(DeclaredModel, ALawHasTheExponentOfItsName) {
  constexpr double kSize_npm3 = 1e10, kFittedExponent = 2.8;
  const Effect cubic =
      test::effect_of(EffectKind::cubic_stiffness, test::in_frame(2), {kSize_npm3});
  const Recorded recorded(test::records_with({cubic}));
  Model fitted = initial_model(recorded.plant);
  fitted.theta = recorded.small.truth;
  const std::vector<FoundEffect> known =
      add_known(recorded.plant, recorded.segments, {cubic}, fitted);
  fitted.effects[0].parameters[1].value = kFittedExponent;
  const Model declared = declared_model(recorded.plant, recorded.segments, fitted, {&known});
  const ModelEffect& law = declared.effects[0];
  EXPECT_DOUBLE_EQ(law.parameters[1].plain(), 3);
  EXPECT_FALSE(law.parameters[1].free);
  EXPECT_NEAR(law.parameters[0].plain() / std::pow(law.deformation, 3) / kSize_npm3, 1, kSizeOff);
}

constexpr double kCubic_npm3 = 1e10;

/// Returns a fit with the effects of `named`, which it puts into `found`.
FitResult fit_with(const Recorded& recorded, const std::vector<Effect>& named,
                   std::vector<FoundEffect>& found) {
  Model start = initial_model(recorded.plant);
  start.theta = recorded.small.truth;
  found = add_known(recorded.plant, recorded.segments, named, start);
  return fit_to_the_end(recorded.fitter, start, {});
}

TEST(RemoveNotNeeded, RemovesTheEffectsThatAreNotInTheRecords) {
  const Effect cubic =
      test::effect_of(EffectKind::cubic_stiffness, test::in_frame(1), {kCubic_npm3});
  const Recorded recorded(test::records_with({cubic}, {1, 2}));
  std::vector<FoundEffect> found;
  FitResult now =
      fit_with(recorded,
               {test::effect_of(EffectKind::quadratic_stiffness, test::in_frame(2), {1e6}), cubic,
                test::effect_of(EffectKind::time_shift, test::at_channel(0), {1e-4})},
               found);
  const double cost = now.cost;
  remove_not_needed(recorded.fitter, {}, found, now);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].chosen.kind, EffectKind::cubic_stiffness);
  ASSERT_EQ(now.model.effects.size(), 1U);
  ASSERT_EQ(found[0].index, 0);
  EXPECT_EQ(now.model.effects[0].place, test::in_frame(1));
  EXPECT_TRUE(now.model.free_clock.empty());
  EXPECT_LT(now.cost, cost + 2 * SearchSettings().min_gain);
}

TEST(RemoveNotNeeded, KeepsTheEffectsOfTheRecords) {
  const std::vector<Effect> both{
      test::effect_of(EffectKind::cubic_stiffness, test::in_frame(1), {kCubic_npm3}),
      test::effect_of(EffectKind::gain_error, test::at_channel(1), {kGain})};
  std::vector<Eigen::MatrixXd> records = test::records_with({both[0]}, {1, 2});
  for (Eigen::MatrixXd& record : records) record.col(1) *= 1 + kGain;
  const Recorded recorded(records);
  std::vector<FoundEffect> found;
  FitResult now = fit_with(recorded, both, found);
  remove_not_needed(recorded.fitter, {}, found, now);
  EXPECT_EQ(found.size(), 2U);
  EXPECT_EQ(now.model.free_gain, std::vector<int>{1});
}

}  // namespace refit_test

}  // namespace framewatch::estimator
