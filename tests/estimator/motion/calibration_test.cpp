// SPDX-License-Identifier: MIT
#include "estimator/motion/acquisition.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace framewatch::estimator {
namespace calibration_test {

constexpr double kGravity = 9.80665;
constexpr double kRounding = 1e-12;
constexpr double kAlong = 0.7, kAcross = -1.3;  // true motion at the sensor, m/s^2

SensorAxis axis(Direction direction) {
  SensorAxis a;
  a.direction = direction;
  return a;
}

TEST(Calibration, AppliesOffsetThenPolarity) {
  SensorAxis a = axis(Direction::x);
  a.offset = 0.2;
  a.polarity = -1;
  std::vector<double> accel{1.2};
  Calibration({a}).apply(accel);
  EXPECT_NEAR(accel[0], -1.0, kRounding);
}

TEST(Calibration, RemovesGravityFromATiltedAxis) {
  for (const double polarity : {1.0, -1.0}) {
    SensorAxis a = axis(Direction::x);
    a.tilt = 0.05;
    a.polarity = polarity;
    std::vector<double> accel{polarity * (std::cos(a.tilt) * kAlong + kGravity * std::sin(a.tilt))};
    Calibration({a}).apply(accel);
    EXPECT_NEAR(accel[0], kAlong, kRounding);
  }
}

TEST(Calibration, SeparatesTwoAxesTurnedInPlan) {
  SensorAxis x = axis(Direction::x), y = axis(Direction::y);
  x.mount_angle = 0.3;
  y.mount_angle = -0.2;
  x.cross = 1;
  y.cross = 0;
  std::vector<double> accel{std::cos(0.3) * kAlong + std::sin(0.3) * kAcross,
                            std::cos(-0.2) * kAcross - std::sin(-0.2) * kAlong};
  Calibration({x, y}).apply(accel);
  EXPECT_NEAR(accel[0], kAlong, kRounding);
  EXPECT_NEAR(accel[1], kAcross, kRounding);
}

TEST(Calibration, WithoutItsCrossAxisATurnedAxisHasNoValue) {
  SensorAxis x = axis(Direction::x), y = axis(Direction::y);
  x.mount_angle = 0.3;
  x.cross = 1;
  std::vector<double> accel{1, std::numeric_limits<double>::quiet_NaN()};
  Calibration({x, y}).apply(accel);
  EXPECT_TRUE(std::isnan(accel[0]));
}

}  // namespace calibration_test
}  // namespace framewatch::estimator
