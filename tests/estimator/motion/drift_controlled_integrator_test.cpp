// SPDX-License-Identifier: MIT
#include "estimator/motion/drift_controlled_integrator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace drift_controlled_integrator_test {

constexpr double kRate = 100;

DriftControlledIntegrator make_filter(int axes) {
  return {std::vector<DerivativeTriple>(static_cast<std::size_t>(axes), matched_triple(kRate)),
          HighPass(0.3, kRate)};
}

TEST(HighPass, HasButterworthGainAtItsCorner) {
  const double corner = 0.3;
  const HighPass hp(corner, kRate);
  double y1 = 0, y2 = 0, x1 = 0, x2 = 0, largest = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = std::sin(2 * M_PI * corner / kRate * i);
    const double y = hp.gain * (x - 2 * x1 + x2) - hp.a1 * y1 - hp.a2 * y2;
    x2 = x1, x1 = x, y2 = y1, y1 = y;
    if (i > 15000) largest = std::max(largest, std::abs(y));
  }
  EXPECT_NEAR(largest, std::sqrt(0.5), 1e-4);
}

TEST(DriftControlledIntegrator, BiasLeavesNoTraceFromTheFirstSampleOn) {
  DriftControlledIntegrator filter = make_filter(1);
  for (int i = 0; i < 500; ++i) {
    filter.push({9.80665});
    EXPECT_EQ(filter.value(0), 0);
    EXPECT_EQ(filter.first(0), 0);
    EXPECT_EQ(filter.second(0), 0);
  }
}

TEST(DriftControlledIntegrator, RampDiesOut) {
  DriftControlledIntegrator filter = make_filter(1);
  double early = 0;
  for (int i = 0; i < 1000; ++i) {
    filter.push({0.05 + 1e-3 * i});
    if (i < 200) early = std::max(early, std::abs(filter.value(0)));
  }
  EXPECT_GT(early, 1e-3);
  EXPECT_LT(std::abs(filter.value(0)), 1e-5 * early);
}

TEST(DriftControlledIntegrator, BiasOnTopOfMotionChangesRoundingOnly) {
  DriftControlledIntegrator filter = make_filter(2);
  for (int i = 0; i < 1000; ++i) {
    const double a = std::sin(0.1 * i) * std::cos(0.013 * i);
    filter.push({a, a + 0.5});
    EXPECT_NEAR(filter.value(0), filter.value(1), 1e-12);
    EXPECT_NEAR(filter.second(0), filter.second(1), 1e-8);
  }
}

TEST(DriftControlledIntegrator, IsValidOnceItsTapsAreFull) {
  DriftControlledIntegrator filter = make_filter(1);
  const int length = matched_triple(kRate).length();
  for (int i = 1; i <= 2 * length; ++i) {
    filter.push({std::sin(0.2 * i)});
    EXPECT_EQ(filter.valid(0), i >= length);
    if (i < length) {
      EXPECT_EQ(filter.value(0), 0);
    }
  }
}

TEST(DriftControlledIntegrator, ALostSampleInvalidatesOnlyItsAxisUntilRefilled) {
  DriftControlledIntegrator filter = make_filter(2), fresh = make_filter(1);
  const int length = matched_triple(kRate).length();
  for (int i = 0; i < 100; ++i) filter.push({std::sin(0.2 * i), std::cos(0.1 * i)});
  for (const double bad : {kNaN, std::numeric_limits<double>::infinity()}) {
    filter.push({bad, 0.1});
    EXPECT_FALSE(filter.valid(0));
    EXPECT_TRUE(filter.valid(1));
    EXPECT_EQ(filter.value(0), 0);
    fresh.reset();
    for (int i = 1; i <= length + 20; ++i) {
      const double a = 3 + std::sin(0.3 * i);
      filter.push({a, 0.1});
      fresh.push({a});
      EXPECT_EQ(filter.valid(0), i >= length);
      EXPECT_EQ(filter.value(0), fresh.value(0)) << "an axis restarts like a new one";
      EXPECT_EQ(filter.second(0), fresh.second(0));
    }
  }
}

TEST(DriftControlledIntegrator, ResetEqualsANewFilter) {
  DriftControlledIntegrator used = make_filter(1), fresh = make_filter(1);
  for (int i = 0; i < 77; ++i) used.push({std::sin(0.9 * i)});
  used.reset();
  EXPECT_FALSE(used.valid(0));
  for (int i = 0; i < 50; ++i) {
    used.push({std::cos(0.4 * i)});
    fresh.push({std::cos(0.4 * i)});
    EXPECT_EQ(used.first(0), fresh.first(0));
  }
}

}  // namespace drift_controlled_integrator_test
}  // namespace framewatch::estimator
