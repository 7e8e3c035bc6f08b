// SPDX-License-Identifier: MIT
#include "daemon/tools/diagnosis/diagnose_verdict.h"

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::daemon {
namespace diagnose_verdict_test {

constexpr double kTrue = test::kNoise_mps2 / 5;  // density: the root of half of 50 Hz is 5

TEST(NoiseBeyondConfigured, NamesChannelsWithMoreThanTwiceTheirNoise) {
  constexpr double kOff = 0.2;
  test::Small small;
  small.axes[0].noise_density = kTrue / 10;
  small.axes[1].noise_density = kTrue;
  small.axes[2].noise_density = 0;  // not configured
  small.axes[4].noise_density = kTrue / 3;
  const estimator::Plant plant = small.plant();
  const auto beyond = noise_beyond_configured(plant, small.segments({small.record({}, 1)}));
  ASSERT_EQ(beyond.size(), 2U);
  EXPECT_EQ(beyond[0].axis, 0U);
  EXPECT_DOUBLE_EQ(beyond[0].configured, kTrue / 10);
  EXPECT_NEAR(beyond[0].read / kTrue, 1, kOff);
  EXPECT_EQ(beyond[1].axis, 4U);
}

TEST(NoiseBeyondConfigured, UsesTheQuietestRecord) {
  test::Small small;
  small.axes[0].noise_density = kTrue;
  const estimator::Plant plant = small.plant();
  Eigen::MatrixXd loud = small.record({}, 1);
  loud.col(0) += 10 * (small.record({}, 2).col(0) - small.record({}, 3).col(0));
  EXPECT_EQ(noise_beyond_configured(plant, small.segments({loud})).size(), 1U);
  EXPECT_TRUE(noise_beyond_configured(plant, small.segments({loud, small.record({}, 4)})).empty());
}

}  // namespace diagnose_verdict_test
}  // namespace framewatch::daemon
