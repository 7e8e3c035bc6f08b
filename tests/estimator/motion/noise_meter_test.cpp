// SPDX-License-Identifier: MIT
#include "estimator/motion/noise_meter.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace noise_meter_test {

constexpr double kRate_hz = 100;
constexpr double kDensity = 2e-4;  // m/s^2/sqrt(Hz)
/// Three standard deviations: a mean of 125 squares has 13 %, its root 6 %.
constexpr double kTolerance = 0.2;

TEST(NoiseMeter, SeesWhiteNoiseUnderAThousandTimesStrongerMotion) {
  NoiseMeter meter(2, kRate_hz);
  Random random(3);
  EXPECT_EQ(meter.density(0), 0);
  for (int t = 0; t < 2000; ++t) {
    const double noise = kDensity * std::sqrt(kRate_hz / 2) * random.normal();
    const double motion = std::sin(0.3 * t) + 0.5 * std::cos(0.9 * t);
    meter.push({motion + noise, 3 * noise});
  }
  EXPECT_NEAR(meter.density(0) / kDensity, 1, 2 * kTolerance);
  EXPECT_NEAR(meter.density(1) / (3 * kDensity), 1, kTolerance);
}

TEST(NoiseMeter, IgnoresAMissingSample) {
  NoiseMeter meter(1, kRate_hz);
  Random random(4);
  for (int t = 0; t < 2000; ++t)
    meter.push({t % 100 == 50 ? std::numeric_limits<double>::quiet_NaN()
                              : 5 + kDensity * std::sqrt(kRate_hz / 2) * random.normal()});
  EXPECT_NEAR(meter.density(0) / kDensity, 1, 2 * kTolerance);
}

}  // namespace noise_meter_test
}  // namespace framewatch::estimator
