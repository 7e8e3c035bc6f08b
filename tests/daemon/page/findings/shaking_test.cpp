// SPDX-License-Identifier: MIT
#include "daemon/page/findings/shaking.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "estimator/numeric/nan.h"
#include "tests/support/config_fixture.h"

namespace framewatch::daemon {
namespace shaking_test {

// Limits.
constexpr double kPeakError = 0.03, kSwellError_s = 5;

constexpr double kRate_hz = 100, kFrequency_hz = 3, kDrift_m = 0.002, kGround_mps2 = 0.4;
constexpr double kOffset_mps2 = 0.3;  // of every sensor: gravity by a tilt
constexpr double kFrom_s = 20, kTo_s = 40, kEnd_s = 80, kSwell_s = 2;
constexpr double kNodeMass_kg = 20;

/// One story in x; frame y2 moves by kDrift_m, frame y1 by half of it.
class ShakingTest : public ::testing::Test {
 protected:
  ShakingTest() : config_(test::good(test::kGoodConfig)), shaking_(config_.pipeline) {}

  estimator::SampleSet at(std::int64_t i, double size) const {
    const double t = static_cast<double>(i) / kRate_hz, w = 2 * std::numbers::pi * kFrequency_hz;
    estimator::SampleSet set;
    set.index = i;
    set.time = estimator::from_microseconds(std::llround(1e6 * t) + 1'700'000'000'000'000);
    const double ground = size * kGround_mps2 * std::sin(0.7 * w * t);
    const double relative = -size * kDrift_m * w * w * std::sin(w * t);
    set.accel = {ground, 0, ground + relative / 2, ground + relative, 0, 0};
    for (double& accel : set.accel) accel += kOffset_mps2;
    return set;
  }
  /// Grows within some seconds, like real motion.
  static double size_at(double t) {
    return 0.25 * (1 + std::tanh((t - kFrom_s) / kSwell_s)) *
           (1 + std::tanh((kTo_s - t) / kSwell_s));
  }
  estimator::PeakDrift story_of(const Shake& shake) const {
    return peak_drift(shake.peak, config_.pipeline.structure, 1);
  }
  double accel_of(const Shake& shake, int level) const {
    return peak_accel_mps2(shake.peak, config_.pipeline.axes, level);
  }
  static double sensor_s(std::int64_t us) { return 1e-6 * static_cast<double>(us) - 1.7e9; }

  Config config_;
  Shaking shaking_;
};

TEST_F(ShakingTest, ReportsDriftOfEachStoryAndBaseShear) {
  for (std::int64_t i = 0; i < std::llround(kEnd_s * kRate_hz); ++i)
    shaking_.push(at(i, size_at(static_cast<double>(i) / kRate_hz)));
  const Shake* shake = shaking_.newest();
  ASSERT_NE(shake, nullptr);
  EXPECT_TRUE(shake->over);
  EXPECT_NEAR(sensor_s(shake->from_us), kFrom_s, kSwellError_s);
  EXPECT_NEAR(sensor_s(shake->to_us), kTo_s, kSwellError_s);
  EXPECT_EQ(story_of(*shake).frame, 1);  // y2
  EXPECT_NEAR(story_of(*shake).ratio, kDrift_m, kPeakError * kDrift_m);
  EXPECT_GT(accel_of(*shake, 1), accel_of(*shake, 0));
  EXPECT_NEAR(accel_of(*shake, 0), kGround_mps2, 2 * kPeakError);
  EXPECT_GT(shake->peak.base_shear_n[0], 2 * kNodeMass_kg * accel_of(*shake, 1));
  EXPECT_LT(shake->peak.base_shear_n[0], 4 * kNodeMass_kg * accel_of(*shake, 1));
}

TEST_F(ShakingTest, IsExactInAMotionThatSwellsSlowly) {
  const double w = 2 * std::numbers::pi * kFrequency_hz;
  for (std::int64_t i = 0; i < std::llround(kEnd_s * kRate_hz); ++i) {
    const double t = static_cast<double>(i) / kRate_hz;
    shaking_.push(at(i, std::exp(-std::pow((t - 35) / 8, 2))));
  }
  const Shake* shake = shaking_.newest();
  ASSERT_NE(shake, nullptr);
  EXPECT_NEAR(story_of(*shake).ratio, kDrift_m, kPeakError * kDrift_m);
  EXPECT_NEAR(accel_of(*shake, 1), kDrift_m * w * w, kGround_mps2);
}

TEST_F(ShakingTest, ReportsNoShakeAtRestAndNoNumberForALostSensor) {
  for (std::int64_t i = 0; i < 3000; ++i) shaking_.push(at(i, 0));
  EXPECT_EQ(shaking_.newest(), nullptr);
  EXPECT_GT(shaking_.first_us(), 0);
  for (std::int64_t i = 3000; i < 6000; ++i) {
    estimator::SampleSet set = at(i, 1);
    set.accel[2] = set.accel[3] = estimator::kNaN;  // both frames along x
    set.accel[4] = std::sin(0.2 * static_cast<double>(i));
    shaking_.push(set);
  }
  const Shake* shake = shaking_.newest();
  ASSERT_NE(shake, nullptr);
  EXPECT_FALSE(shake->over);
  EXPECT_TRUE(std::isnan(shake->peak.base_shear_n[0]));
  EXPECT_GT(shake->peak.base_shear_n[1], 0);
  EXPECT_EQ(story_of(*shake).frame, 2);  // x1, the only measured frame that moves
}

TEST_F(ShakingTest, KeepsTheStrongestBesideTheNewest) {
  for (std::int64_t i = 0; i < 9000; ++i) {
    const double t = static_cast<double>(i) / kRate_hz;
    shaking_.push(
        at(i, std::exp(-std::pow((t - 25) / 3, 2)) + 0.2 * std::exp(-std::pow((t - 65) / 3, 2))));
  }
  ASSERT_NE(shaking_.newest(), nullptr);
  EXPECT_NEAR(sensor_s(shaking_.newest()->from_us), 61, 4);
  EXPECT_NEAR(sensor_s(shaking_.strongest()->from_us), 19, 4);
  EXPECT_GT(story_of(*shaking_.strongest()).ratio, 3 * story_of(*shaking_.newest()).ratio);
}

}  // namespace shaking_test
}  // namespace framewatch::daemon
