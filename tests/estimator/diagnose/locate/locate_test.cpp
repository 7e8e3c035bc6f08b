// SPDX-License-Identifier: MIT
#include "estimator/diagnose/locate/locate.h"

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/flicker.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace locate_test {

constexpr double kCorner_hz = 4;

std::vector<Eigen::MatrixXd> records_with_spring() {
  return test::records_with(
      {test::effect_of(EffectKind::cubic_stiffness, test::in_frame(1), {1e10})}, {1, 2});
}

TEST(NoiseCornerAtPlace, IsFoundForFlickerNoiseDespiteALawThere) {
  test::Recorded r(test::with_flicker(records_with_spring(), kCorner_hz));
  ASSERT_TRUE(set_noise_corner_at(r.fitter, r.segments, r.freed(test::in_frame(1))));
  EXPECT_NEAR(r.segments.front().corner_hz / kCorner_hz, 1, 0.35);
}

TEST(NoiseCornerAtPlace, IsNotFoundInWhiteNoise) {
  test::Recorded r(records_with_spring());
  EXPECT_FALSE(set_noise_corner_at(r.fitter, r.segments, r.freed(test::in_frame(1))));
  EXPECT_EQ(r.segments.front().corner_hz, 0);
}

}  // namespace locate_test
}  // namespace framewatch::estimator
