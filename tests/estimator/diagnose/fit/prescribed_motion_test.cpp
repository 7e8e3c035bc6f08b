#include "estimator/diagnose/fit/prescribed_motion.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/small_building.h"

namespace framewatch::estimator {
namespace prescribed_motion_test {

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

/// One component whose first axis measures displacement; the band begins above its slow motion.
RecordSegment segment_of(const std::vector<char>& displaced) {
  Eigen::MatrixXd samples = Eigen::MatrixXd::Zero(1501, 2);
  for (Index i = 0; i < samples.rows(); ++i)
    samples(i, 0) = displacement(static_cast<double>(i) / kRate_hz);
  return make_segment(samples, kRate_hz, Eigen::VectorXd::Constant(2, 1e-6), {0.7, 12}, displaced);
}

TEST(PrescribedMotion, KeepsWhatIsSlowerThanTheBand) {
  Plant plant = test::Small().plant();
  plant.prescribed = true;
  const RecordSegment s = segment_of({1, 0});
  const RowVectorXd sense = (RowVectorXd(2) << 1, 0).finished();
  const auto motion = prescribed_motion(plant, s, sense, kRatio);
  ASSERT_TRUE(motion);
  ASSERT_EQ(motion->d.size(), s.intervals() * kRatio);
  const double mean = displacement(0) - s.accel(0, 0);
  for (Index i = motion->d.size() / 10; i < 9 * motion->d.size() / 10; ++i) {
    const double t = static_cast<double>(i) / (kRate_hz * kRatio);
    ASSERT_NEAR(motion->d[i] + mean, displacement(t), kTolerance * kAmplitude_m) << t;
    ASSERT_NEAR(motion->v[i], velocity(t), kTolerance * velocity(0)) << t;
  }
}

TEST(PrescribedMotion, IsOfMeasuredDisplacementsAlone) {
  Plant plant = test::Small().plant();
  const RowVectorXd sense = (RowVectorXd(2) << 1, 0).finished();
  EXPECT_FALSE(prescribed_motion(plant, segment_of({1, 0}), sense, kRatio)) << "not prescribed";
  plant.prescribed = true;
  EXPECT_FALSE(prescribed_motion(plant, segment_of({0, 0}), sense, kRatio)) << "accelerations";
}

}  // namespace prescribed_motion_test
}  // namespace framewatch::estimator
