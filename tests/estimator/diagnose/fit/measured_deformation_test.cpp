// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/measured_deformation.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/small_building.h"

namespace framewatch::estimator {
namespace measured_deformation_test {

using Eigen::Index;
using Eigen::RowVectorXd;

constexpr double kRate_hz = 100, kSlow_hz = 0.07, kFast_hz = 2, kAmplitude_m = 0.01;
constexpr int kRatio = 4;
constexpr double kTolerance = 0.01;  // of the largest deformation and rate, away from the ends

double displacement(double t) {
  return kAmplitude_m *
         (std::sin(2 * M_PI * kFast_hz * t) + 0.5 * std::sin(2 * M_PI * kSlow_hz * t));
}

double velocity(double t) {
  return 2 * M_PI * kAmplitude_m *
         (kFast_hz * std::cos(2 * M_PI * kFast_hz * t) +
          0.5 * kSlow_hz * std::cos(2 * M_PI * kSlow_hz * t));
}

/// Returns one component whose first axis measures displacement. The band begins above its slow
/// motion.
RecordSegment segment_of(const std::vector<char>& displaced) {
  Eigen::MatrixXd samples = Eigen::MatrixXd::Zero(1501, 2);
  for (Index i = 0; i < samples.rows(); ++i)
    samples(i, 0) = displacement(static_cast<double>(i) / kRate_hz);
  return make_segment(samples, kRate_hz, Eigen::VectorXd::Constant(2, 1e-6), {0.7, 12}, displaced);
}

TEST(MeasuredDeformation, KeepsSlowPrescribedMotion) {
  Plant plant = test::Small().plant();
  plant.prescribed = true;
  const RecordSegment s = segment_of({1, 0});
  const RowVectorXd sense = (RowVectorXd(2) << 1, 0).finished();
  const MeasuredDeformation motion = measured_deformation(plant, s, sense, s.spectrum, kRatio);
  ASSERT_EQ(motion.d.size(), s.intervals() * kRatio);
  const double mean = displacement(0) - s.accel(0, 0);
  for (Index i = motion.d.size() / 10; i < 9 * motion.d.size() / 10; ++i) {
    const double t = static_cast<double>(i) / (kRate_hz * kRatio);
    ASSERT_NEAR(motion.d[i] + mean, displacement(t), kTolerance * kAmplitude_m) << t;
    ASSERT_NEAR(motion.v[i], velocity(t), kTolerance * velocity(0)) << t;
  }
}

/// Accelerations with a part that is faster than the band.
TEST(MeasuredDeformation, KeepsOnlyMotionFasterThanTheBand) {
  constexpr double kFaster_hz = 20;
  const auto of = [](double slow_mps2, double fast_mps2, double t) {
    return slow_mps2 * std::sin(2 * M_PI * kFast_hz * t) +
           fast_mps2 * std::cos(2 * M_PI * kFaster_hz * t);
  };
  Eigen::MatrixXd samples = Eigen::MatrixXd::Zero(1501, 2);
  for (Index i = 0; i < samples.rows(); ++i) {
    const double t = static_cast<double>(i) / kRate_hz;
    samples(i, 0) = of(2, 30, t) + std::sin(2 * M_PI * 0.2 * t);
  }
  const RecordSegment s =
      make_segment(samples, kRate_hz, Eigen::VectorXd::Constant(2, 1e-6), {0.7, 12});
  const RowVectorXd sense = (RowVectorXd(2) << 1, 0).finished();
  for (const bool prescribed : {false, true}) {
    Plant plant = test::Small().plant();
    plant.prescribed = prescribed;
    const MeasuredDeformation motion = measured_deformation(plant, s, sense, s.spectrum, kRatio);
    ASSERT_EQ(motion.d.size(), s.intervals() * kRatio);
    const double w = 2 * M_PI * kFast_hz, faster = 2 * M_PI * kFaster_hz;
    for (Index i = motion.d.size() / 10; i < 9 * motion.d.size() / 10; ++i) {
      const double t = static_cast<double>(i) / (kRate_hz * kRatio);
      const double rate = -2 / w * std::cos(w * t) + 30 / faster * std::sin(faster * t);
      ASSERT_NEAR(motion.d[i], -of(2 / w / w, 30 / faster / faster, t), kTolerance * 2 / w / w)
          << t;
      ASSERT_NEAR(motion.v[i], rate, kTolerance * 30 / faster) << t;
    }
  }
}

}  // namespace measured_deformation_test
}  // namespace framewatch::estimator
