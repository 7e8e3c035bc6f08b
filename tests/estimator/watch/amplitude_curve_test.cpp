// SPDX-License-Identifier: MIT
#include "estimator/watch/amplitude_curve.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"
#include "estimator/watch/baseline.h"

namespace framewatch::estimator {
namespace amplitude_curve_test {

constexpr double kError = 0.003, kSoftening = 0.15;
constexpr double kWeakest_m = 1e-5, kStrongest_m = 1e-3;

/// Relative stiffness that saturates with amplitude.
double softened(double amplitude_m) {
  return 1 - kSoftening * amplitude_m / (amplitude_m + 2e-4);
}

AmplitudeBins learned(std::uint64_t seed, int windows, double error) {
  Random random(seed);
  AmplitudeBins bins;
  for (int i = 0; i < windows; ++i) {
    const double a = kWeakest_m * std::pow(kStrongest_m / kWeakest_m, random.uniform());
    bins.push(a, softened(a) + error * random.normal() - 1, 1 / (kError * kError));
  }
  return bins;
}

TEST(AmplitudeCurve, FitsALawWithinItsErrors) {
  constexpr int kDraws = 20, kPlaces = 10;
  constexpr double kMaxMissed = 0.02;  // of 3 errors
  int missed = 0, places = 0;
  for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
    const AmplitudeCurve curve(1, kError / std::sqrt(200), learned(seed, 200, kError).points(1));
    for (int i = 0; i <= kPlaces; ++i, ++places) {
      const double a =
          kWeakest_m * std::pow(kStrongest_m / kWeakest_m, static_cast<double>(i) / kPlaces);
      const AmplitudeCurve::Expected e = curve.expected(a);
      missed += std::abs(e.ratio - softened(a)) > 3 * e.std_error ? 1 : 0;
      EXPECT_LT(e.std_error, 0.005);
    }
  }
  EXPECT_LE(missed, kMaxMissed * places);
}

TEST(AmplitudeCurve, ErrorGrowsTowardSofteningBeyondTheLearnedRange) {
  const AmplitudeCurve curve(1, kError / std::sqrt(100), learned(1, 100, kError).points(1));
  const double top = kStrongest_m, beyond = 10 * top, below = kWeakest_m / 10;
  EXPECT_GT(curve.expected(beyond).std_error, 10 * curve.expected(top).std_error);
  EXPECT_LT(curve.least(beyond, 3), curve.least(top, 3) - 0.05);
  EXPECT_LT(curve.most(beyond, 3), curve.most(top, 3) + 0.01);
  EXPECT_GT(curve.most(below, 3), curve.most(kWeakest_m, 3) + 0.05);
  EXPECT_GT(curve.least(below, 3), curve.least(kWeakest_m, 3) - 0.01);
}

TEST(AmplitudeCurve, EqualsTheValueAtASingleAmplitude) {
  const AmplitudeCurve curve(2, 0.001, {{1e-4, 2, 0.002}});
  ASSERT_TRUE(curve.known());
  EXPECT_NEAR(curve.expected(1e-4).ratio, 1, 1e-5);
  EXPECT_NEAR(curve.expected(1e-4).std_error, 0.001, 1e-4);
  EXPECT_NEAR(curve.expected(1e-3).std_error, AmplitudeCurve::kUsualPerLog * std::log(10), 0.05);
  EXPECT_FALSE(AmplitudeCurve(2, 0.001, {}).known());
}

TEST(AmplitudeBins, ScatterExcludesTheEffectOfAmplitude) {
  EXPECT_LT(learned(3, 300, kError).excess(), 1.3);
  EXPECT_GT(learned(3, 300, 3 * kError).excess(), 6);
}

TEST(AmplitudeBins, OutermostBinsIncludeLargerAndSmallerAmplitudes) {
  AmplitudeBins bins;
  for (const double a : {1e-4, 1e-30, 1e30, 1e-300, 1e300}) bins.push(a, 0, 1);
  EXPECT_EQ(bins.points(1).size(), 3u);
  for (const AmplitudePoint& p : bins.points(1)) EXPECT_TRUE(p.valid());
}

TEST(RecentAmplitude, ForgetsInInverseProportionToTime) {
  RecentAmplitude recent;
  EXPECT_EQ(recent.at(5), 0);
  recent.push(100, 1);
  for (double t = 101; t < 1000; ++t) recent.push(t, 1e-3);
  EXPECT_NEAR(recent.at(105), 1, 1e-12);
  EXPECT_NEAR(recent.at(100 + 100), RecentAmplitude::kHolds_s / 100, 1e-12);
  EXPECT_NEAR(recent.at(1e9), 0, 1e-6);
}

TEST(RecentAmplitude, IsBoundedAndKeepsTheLargestContributions) {
  RecentAmplitude recent;
  for (int i = 0; i < 100; ++i) recent.push(i, std::pow(0.9, i));
  recent.push(100, 0.5);  // stronger than most of what came before
  EXPECT_NEAR(recent.at(100), 0.5, 0.01);
}

TEST(Baseline, ReadsItsPointsBackAndRefusesOthers) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Baseline b(2);
  b.by_amplitude[1] = {{1e-4, 2, 0.1}, {2e-4, 1.9, 0.1}};
  Baseline read(2);
  ASSERT_TRUE(read.take_points(b.flat_points()));
  ASSERT_EQ(read.by_amplitude[1].size(), 2u);
  EXPECT_EQ(read.by_amplitude[1][1].value, 1.9);
  EXPECT_TRUE(read.by_amplitude[0].empty());
  const std::vector<std::vector<double>> wrong{{0},
                                               {0, 1, 1e-4, 2},
                                               {0, -1},
                                               {0, 1e9},
                                               {0, kNan},
                                               {0, 0, 0},
                                               {0, 1, -1e-4, 2, 0.1},
                                               {0, 1, 1e-4, kNan, 0.1}};
  for (const std::vector<double>& numbers : wrong) EXPECT_FALSE(read.take_points(numbers));
}

}  // namespace amplitude_curve_test
}  // namespace framewatch::estimator
