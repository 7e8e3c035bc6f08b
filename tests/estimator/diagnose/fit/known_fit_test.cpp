// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/fit/law_tracks.h"
#include "estimator/diagnose/fit/unknowns.h"
#include "tests/estimator/diagnose/exact_record.h"

namespace framewatch::estimator {
namespace known_fit_test {

using test::Small;

struct Case {
  Small small;
  Plant plant = small.plant();
  std::vector<RecordSegment> segments;
  Fitter fitter;

  explicit Case(const Eigen::MatrixXd& record, const Tolerances& tolerances = {})
      : segments(small.segments({record})), fitter(plant, segments, tolerances) {}
};

TEST(KnownFit, FindsTheTruthWithoutNoise) {
  constexpr double kTolerance = 5e-3;
  const Case c(test::exact_record(Small(), {}, 1), {0, 0, 0});
  const FitResult fit = c.fitter.fit(initial_model(c.plant), {}, {});
  ASSERT_TRUE(fit.good);
  for (int f = 0; f < 4; ++f)
    EXPECT_NEAR(fit.model.theta[f] / c.small.truth[f], 1, kTolerance) << f;
}

TEST(KnownFit, FindsAnEffectsValueInNoise) {
  constexpr double kTolerance = 0.1;
  const test::EffectTwins twins = test::extra_mass(1, 8000);
  const Case c(Small().record({twins.simulated}, 2));
  Model start = test::with_effects(initial_model(c.plant), {twins.modelled});
  start.effects[0].parameters[0].value = 4000;
  const FitResult fit = c.fitter.fit(start, {}, {});
  ASSERT_TRUE(fit.good);
  EXPECT_NEAR(fit.model.effects[0].parameters[0].plain() / 8000, 1, kTolerance);
  EXPECT_LT(fit.cost, c.fitter.fit(start, {}, {Forcing::measured, 0}).cost);
}

TEST(KnownFit, KeepsAModelWithoutStepsAndRejectsNan) {
  const Case c(Small().record({}, 1));
  Model model = initial_model(c.plant);
  const FitResult fit = c.fitter.fit(model, {}, {Forcing::measured, 0});
  ASSERT_TRUE(fit.good);
  EXPECT_EQ(fit.model.theta, model.theta);
  EXPECT_NEAR(fit.cost, fit.total_misfit() + c.fitter.prior_cost(model), 1e-9 * fit.cost);
  model.theta[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(c.fitter.fit(model, {}, {}).good);
}

TEST(KnownFit, PriorOfOneDeviationCostsAHalf) {
  const Case c(Small().record({}, 1));
  Model model = initial_model(c.plant);
  EXPECT_NEAR(c.fitter.prior_cost(model), 0, 1e-12);
  model.gain[2] = c.fitter.tolerances().gain;
  EXPECT_NEAR(c.fitter.prior_cost(model), 0.5, 1e-12);
  model.mass_change[0] = -2 * c.fitter.tolerances().mass;
  EXPECT_NEAR(c.fitter.prior_cost(model), 2.5, 1e-12);
}

}  // namespace known_fit_test
}  // namespace framewatch::estimator
