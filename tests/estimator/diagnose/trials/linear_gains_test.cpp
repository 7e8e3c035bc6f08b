// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/linear_gains.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/hand_made_trials.h"

namespace framewatch::estimator {
namespace linear_gains_test {

using test::HandMade;

ModelEffect mass_at(int crossing) {
  ModelEffect out;
  out.form = LawForm::mass;
  out.place = test::at_crossing(crossing);
  out.parameters = {bounded_parameter(700, 100, -20000, 1e15)};
  return out;
}

TEST(LinearGains, PredictTheFitOfAnEffectInOneStep) {
  constexpr double kMass_kg = 3000, kOff = 0.15;
  constexpr int kCrossing = 1;
  const HandMade made(test::records_with(
      {test::effect_of(EffectKind::extra_mass, test::at_crossing(kCrossing), {kMass_kg})}));
  std::vector<ModelEffect> effects;
  for (int crossing = 0; crossing < 4; ++crossing) effects.push_back(mass_at(crossing));
  const std::vector<LinearGain> gains = linear_gains(made.context(), effects);
  ASSERT_EQ(gains.size(), 4u);
  Model model = made.now.model;
  model.effects = {effects[kCrossing]};
  const FitResult fit = made.recorded.fitter.fit(model, made.now.motion, {});
  EXPECT_NEAR(gains[kCrossing].cost / (made.now.cost - fit.cost), 1, kOff);
  EXPECT_NEAR(gains[kCrossing].value / fit.model.effects[0].parameters[0].value, 1, kOff);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_TRUE(i == kCrossing || gains[i].cost < gains[kCrossing].cost) << i;
}

TEST(LinearGains, AreZeroIfNothingIsMissing) {
  constexpr double kChance = 12;
  const HandMade nothing;
  for (const LinearGain& gain : linear_gains(nothing.context(), {mass_at(0), mass_at(3)}))
    EXPECT_LT(gain.cost, kChance);
}

TEST(LinearGains, AreZeroForAnInvalidModel) {
  HandMade broken;
  broken.now.model.theta.setConstant(std::nan(""));
  EXPECT_EQ(linear_gains(broken.context(), {mass_at(0)}).front().cost, 0);
}

}  // namespace linear_gains_test
}  // namespace framewatch::estimator
