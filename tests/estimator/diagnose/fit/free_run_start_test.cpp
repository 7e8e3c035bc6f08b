// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/free_run_start.h"

#include <gtest/gtest.h>

#include "estimator/diagnose/law/law.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace free_run_start_test {

constexpr int kFrame = 2;         // of 8e6 N/m; without friction it deforms by about 16 mm
constexpr double kWithin = 1.25;  // tried forces differ by factors of 1.09

class FrictionStart : public testing::TestWithParam<double> {};

TEST_P(FrictionStart, IsNearTheForceOfStickingFriction) {
  const double force_n = GetParam();
  const EffectPlace place = test::in_frame(kFrame);
  Effect hidden = make_effect(EffectKind::coulomb_friction, place);
  hidden.set("fc_n", force_n);
  hidden.set("v0_mps", 1e-3);
  const test::Recorded recorded(test::records_with({hidden}));
  const Localisation freed = recorded.freed(place);
  ModelEffect friction;
  friction.form = LawForm::friction;
  friction.place = place;
  friction.deformation = 5e-3;
  friction.rate = 0.1;
  friction.parameters = {linear_parameter(1, 1), logarithmic_parameter(0.01, 1e-5, 0.03),
                         bounded_parameter(0, 0.02, -0.8, 8, false),
                         logarithmic_parameter(0.02, 1e-3, 0.1),
                         bounded_parameter(0, 1e-5, 0, 1e-3, false)};
  friction.parameters[3].free = false;
  Model model = freed.model;
  model.effects = {friction};
  const std::vector<FitResult> starts = friction_starts(recorded.fitter, model);
  ASSERT_FALSE(starts.empty());
  const FitResult& start = starts.front();
  const double force = start.model.effects[0].parameters[FrictionIndex::fc].plain();
  EXPECT_GT(force, force_n / kWithin);
  EXPECT_LT(force, force_n * kWithin);
  FitOptions options;
  options.forcing = Forcing::simulated;
  options.max_steps = 20;
  const FitResult end = recorded.fitter.fit(start.model, {}, options);
  ASSERT_TRUE(end.good);
  EXPECT_LT(end.total_misfit(), 2 * recorded.fitter.expected(end.model));
  EXPECT_NEAR(end.model.effects[0].parameters[FrictionIndex::fc].plain() / force_n, 1, 0.02);
}

// The last two stick most of the time.
INSTANTIATE_TEST_SUITE_P(Forces, FrictionStart, testing::Values(1e4, 2.5e4, 4e4));

}  // namespace free_run_start_test
}  // namespace framewatch::estimator
