#include "estimator/diagnose/spectra/fourier.h"

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace delay_test {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kRate_hz = 50;
constexpr Index kSamples = 3000, kLate = 40;
constexpr Band kBand{0.2, 2};
constexpr double kAlike = 0.9;

/// Random motion, and the same `kLate` samples later with noise and another size.
struct Readings {
  VectorXd first{kSamples}, second{kSamples};

  explicit Readings(double factor) {
    Random random(3);
    VectorXd motion(kSamples + kLate);
    for (double& x : motion) x = random.normal();
    first = motion.tail(kSamples);
    second = factor * motion.head(kSamples);
    for (double& x : second) x += 0.1 * random.normal();
  }
};

TEST(Delay, IsFoundOfMotionOfAnySizeAndSign) {
  for (const double factor : {1.5, -0.7}) {
    const Readings r(factor);
    const Delay late = delay_between(r.first, r.second, kRate_hz, kBand);
    EXPECT_DOUBLE_EQ(late.seconds, kLate / kRate_hz);
    EXPECT_GT(late.likeness, kAlike);
    EXPECT_LE(late.likeness, 1);
    EXPECT_LT(late.undelayed, 0.5);
    EXPECT_DOUBLE_EQ(delay_between(r.second, r.first, kRate_hz, kBand).seconds, -late.seconds);
  }
}

TEST(Delay, UnlikeReadingsHaveNone) {
  Random random(4);
  VectorXd first(kSamples), second(kSamples);
  for (Index i = 0; i < kSamples; ++i) {
    first[i] = random.normal();
    second[i] = random.normal();
  }
  EXPECT_LT(delay_between(first, second, kRate_hz, kBand).likeness, 0.6);
}

TEST(Delay, NeedsFrequenciesInTheBandAndMotion) {
  const Readings r(1);
  EXPECT_EQ(delay_between(r.first, r.second, kRate_hz, {0.2, 0.25}).likeness, 0);
  EXPECT_EQ(delay_between(r.first, VectorXd::Zero(kSamples), kRate_hz, kBand).likeness, 0);
  EXPECT_EQ(delay_between(r.first, VectorXd(), kRate_hz, kBand).likeness, 0);
}

}  // namespace delay_test
}  // namespace framewatch::estimator
