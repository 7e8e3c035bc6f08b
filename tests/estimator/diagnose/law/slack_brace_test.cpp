// SPDX-License-Identifier: MIT
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/diagnose/law/law.h"
#include "estimator/simulate/make_law.h"
#include "tests/estimator/diagnose/effect_of.h"
#include "tests/estimator/diagnose/small_building.h"

namespace framewatch::estimator {
namespace slack_brace_test {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kRounding = 1e-12;
constexpr double kStiffness = 4e6, kYields_m = 2e-3;

LawValues brace(double play_m) {
  return {LawForm::slack, {kStiffness, kYields_m, play_m}, 1, 1};
}

VectorXd brace_force(const LawValues& law, const VectorXd& d) {
  return law_force(law, d, VectorXd::Zero(d.size()), 0.01) / (kStiffness * kYields_m);
}

TEST(SlackBrace, PullsFromItsPlasticDeformation) {
  VectorXd d(6), expected(6);
  d << 4, 3.5, 0, 3, 5, -0.5;
  expected << 1, 0.5, 0, 0, 1, -0.5;  // yields, returns, is slack, is tight again
  EXPECT_LT((brace_force(brace(0), kYields_m * d) - expected).norm(), kRounding);
  d << 0.2, -0.3, 0.8, -2, -1.2, 0;
  expected << 0, 0, 0.5, -1, -0.2, 0;
  EXPECT_LT((brace_force(brace(0.3 * kYields_m), kYields_m * d) - expected).norm(), kRounding);
}

/// The simulator takes steps of a tenth.
TEST(SlackBrace, MatchesTheSimulator) {
  constexpr int kFiner = 10;
  constexpr Index kSteps = 2000;
  constexpr double kPlay_m = 0.3 * kYields_m;
  Effect effect = make_effect(EffectKind::pinching, test::frame_place(0));
  effect.set("kh_npm", kStiffness);
  effect.set("dy_m", kYields_m);
  effect.set("slack", 1);
  effect.set("play_m", kPlay_m);
  const auto simulated = make_law(effect, test::Small::one_story());
  const auto deformation = [](double turn) {
    return 4 * kYields_m * turn * std::sin(2 * M_PI * 5 * turn);
  };
  VectorXd d(kSteps), force(kSteps);
  for (Index i = 0; i < kSteps; ++i) {
    for (int fine = 0; fine < kFiner; ++fine)
      simulated->begin_step(
          0,
          deformation((static_cast<double>(i) + static_cast<double>(fine) / kFiner - 1) / kSteps));
    d[i] = deformation(static_cast<double>(i) / kSteps);
    force[i] = simulated->force(0, d[i], 0, {}) / (kStiffness * kYields_m);
  }
  EXPECT_NEAR(force.maxCoeff(), 1, kRounding);
  EXPECT_LT((brace_force(brace(kPlay_m), d) - force).cwiseAbs().maxCoeff(), 1e-3);
}

}  // namespace slack_brace_test
}  // namespace framewatch::estimator
