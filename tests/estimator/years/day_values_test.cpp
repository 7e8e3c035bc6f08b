// SPDX-License-Identifier: MIT
// Tests the values that the watch for years takes: means of a day, and damping as a stiffness.
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/numeric/nan.h"
#include "estimator/years/damping_days.h"
#include "estimator/years/years_watch.h"

namespace framewatch::estimator {
namespace day_values_test {

TEST(Damping, AndItsStiffnessAreEachOthersInverse) {
  const DayValue of_damping = as_stiffness({3e4, 300});
  EXPECT_NEAR(std::pow(of_damping.value, -kDampingPower), 3e4, 1e-6);
  EXPECT_NEAR(of_damping.std_error / of_damping.value, 0.01 / kDampingPower, 1e-12);
  EXPECT_TRUE(std::isnan(as_stiffness({kNaN, kNaN}).value));
  EXPECT_TRUE(std::isnan(as_stiffness({-1, 1}).value));
  const double loss = std::pow(1.5, -1 / kDampingPower) - 1;
  const YearsWatch::Finding grown = as_damping({0, 2, 1, loss, 1e-3});
  EXPECT_NEAR(grown.ratio, 0.5, 1e-9);
  const double slope = (std::pow(1 + loss - 1e-6, -kDampingPower) - 1.5) / 1e-6;
  EXPECT_NEAR(grown.std_error, 1e-3 * slope, 1e-6);
}

TEST(DayMean, StatesTheLargerOfErrorAndScatter) {
  DayMean alike, apart;
  for (const double v : {100.0, 100.0, 100.0, 100.0}) alike.push(v, 2);
  for (const double v : {90.0, 110.0, 90.0, 110.0}) apart.push(v, 2);
  EXPECT_DOUBLE_EQ(alike.mean().std_error, 1);
  EXPECT_NEAR(apart.mean().std_error, 10 / std::sqrt(3), 1e-9);
  EXPECT_TRUE(std::isnan(DayMean().mean().value));
}

}  // namespace day_values_test
}  // namespace framewatch::estimator
