// SPDX-License-Identifier: MIT
#include "estimator/simulate/ground_motion.h"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

namespace framewatch::estimator {
namespace ground_motion_test {

/// Returns the mean power of the motion around a frequency, by direct Fourier sums.
double power(const GroundMotion& motion, double low_hz, double high_hz) {
  double sum = 0;
  int count = 0;
  for (double f = low_hz; f < high_hz; f += 1 / motion.duration_s(), ++count) {
    std::complex<double> amplitude = 0;
    for (std::size_t i = 0; i < motion.accel.size(); ++i)
      amplitude +=
          motion.accel[i] * std::polar(1.0, -2 * M_PI * f * motion.step_s * static_cast<double>(i));
    sum += std::norm(amplitude);
  }
  return sum / count;
}

TEST(GroundMotion, IsLinearBetweenSamplesAndZeroOutside) {
  const GroundMotion motion{0.5, {1, 3, 2}};
  EXPECT_DOUBLE_EQ(motion.at(0), 1);
  EXPECT_DOUBLE_EQ(motion.at(0.25), 2);
  EXPECT_DOUBLE_EQ(motion.at(1.0), 2);
  EXPECT_EQ(motion.at(1.01), 0);
  EXPECT_EQ(motion.at(-0.01), 0);
  EXPECT_DOUBLE_EQ(motion.duration_s(), 1.0);
  EXPECT_DOUBLE_EQ(motion.peak(), 3);
  EXPECT_EQ((GroundMotion{0.5, {}}.at(0)), 0);
}

TEST(GroundMotion, KeepsItsEndSampleDespiteRounding) {
  const GroundMotion motion{0.1, std::vector<double>(31, 1.0)};
  double t = 0;
  for (int i = 0; i < 30; ++i) t += 0.1;
  ASSERT_GT(t, 3.0);
  EXPECT_EQ(motion.at(t), 1);
}

TEST(GroundMotion, ArrivesAtItsAngle) {
  const PlanMotion plan = directed({0.1, {2, -4}}, M_PI / 6);
  EXPECT_NEAR(plan.x.accel[1], -4 * std::sqrt(3) / 2, 1e-15);
  EXPECT_NEAR(plan.y.accel[1], -2, 1e-15);
}

TEST(KanaiTajimi, HasItsPeakLengthAndIsReproducible) {
  const KanaiTajimi p{.peak_mps2 = 3.2, .duration_s = 12, .seed = 5};
  const GroundMotion motion = kanai_tajimi(p);
  EXPECT_EQ(motion.accel.size(), 1201u);
  EXPECT_NEAR(motion.peak(), 3.2, 1e-12);
  EXPECT_EQ(motion.accel, kanai_tajimi(p).accel);
  KanaiTajimi other = p;
  other.seed = 6;
  EXPECT_NE(motion.accel, kanai_tajimi(other).accel);
}

TEST(KanaiTajimi, ShakesMostAtTheGroundsFrequency) {
  const GroundMotion motion = kanai_tajimi({.ground_frequency_hz = 3,
                                            .ground_damping_ratio = 0.3,
                                            .high_pass_hz = 0.3,
                                            .duration_s = 60,
                                            .strong_s = 58});
  const double at_ground = power(motion, 2.5, 3.5);
  EXPECT_GT(at_ground, 5 * power(motion, 10, 15));
  EXPECT_GT(at_ground, 2 * power(motion, 0.4, 1.2));
  EXPECT_GT(power(motion, 0.6, 1.2), 20 * power(motion, 0, 0.1));
}

TEST(KanaiTajimi, BuildsUpAndDecays) {
  const GroundMotion motion =
      kanai_tajimi({.duration_s = 30, .build_up_s = 5, .strong_s = 10, .decay_s = 3});
  const auto rms = [&](double from_s, double to_s) {
    double sum = 0;
    int n = 0;
    for (double t = from_s; t < to_s; t += motion.step_s, ++n) sum += motion.at(t) * motion.at(t);
    return std::sqrt(sum / n);
  };
  EXPECT_LT(rms(0, 1), 0.2 * rms(5, 15));
  EXPECT_LT(rms(28, 30), 0.1 * rms(5, 15));
}

}  // namespace ground_motion_test
}  // namespace framewatch::estimator
