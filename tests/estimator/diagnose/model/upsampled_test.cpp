// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/diagnose/model/free_run.h"
#include "estimator/diagnose/spectra/fourier.h"
#include "tests/estimator/diagnose/other_buildings.h"

namespace framewatch::estimator {
namespace upsampled_test {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kSize = 200, kEdge = 13;  // samples that the sinc needs on either side

double wave(double cycles_per_sample, double at) {
  return std::sin(2 * M_PI * cycles_per_sample * at + 0.3);
}

VectorXd sampled(double cycles_per_sample) {
  VectorXd out(kSize);
  for (Index i = 0; i < kSize; ++i) out[i] = wave(cycles_per_sample, static_cast<double>(i));
  return out;
}

TEST(Upsampled, FollowsTheWaveDelayedByTheShift) {
  struct Case {
    double cycles_per_sample, tolerance;
  };
  for (const Case& c : {Case{0.02, 1e-4}, Case{0.1, 1e-4}, Case{0.3, 1e-3}})
    for (const int ratio : {1, 2, 5})
      for (const double shift : {0.0, 0.25, -0.4, 3.7}) {
        const VectorXd fine = upsampled(sampled(c.cycles_per_sample), ratio, shift);
        ASSERT_EQ(fine.size(), kSize * ratio);
        double worst = 0;
        for (Index i = (kEdge + 4) * ratio; i < (kSize - kEdge - 4) * ratio; ++i)
          worst = std::max(worst, std::abs(fine[i] - wave(c.cycles_per_sample,
                                                          static_cast<double>(i) / ratio - shift)));
        EXPECT_LT(worst, c.tolerance) << c.cycles_per_sample << " " << ratio << " " << shift;
      }
}

TEST(Upsampled, KeepsSamplesAndConstants) {
  constexpr double kRounding = 1e-12;
  const VectorXd signal = sampled(0.17);
  EXPECT_EQ(upsampled(signal, 1), signal);
  const VectorXd fine = upsampled(signal, 4);
  for (Index i = 0; i < kSize; ++i) EXPECT_NEAR(fine[4 * i], signal[i], kRounding);
  // Up to the ends, whose values are held.
  EXPECT_LT((upsampled(VectorXd::Constant(30, 2.5), 3, 0.3).array() - 2.5).matrix().norm(),
            kRounding);
  EXPECT_EQ(upsampled(VectorXd(), 3).size(), 0);
}

struct Shaking {
  double highest_hz;        ///< of the design
  double slow_hz, fast_hz;  ///< of the top's acceleration, of equal size; 0: at rest
  int steps;
};

TEST(StepsPerSample, ResolveTheDisplacementOfTheFloors) {
  constexpr double kRate = 100;
  constexpr Index kSamples = 2001;
  Plant plant = test::SingleMass().plant();
  for (const Shaking& c :
       {Shaking{500, 10, 10, 3}, Shaking{500, 20.1, 20.1, 7}, Shaking{500, 3, 3, 2},
        Shaking{500, 10, 20, 6}, Shaking{500, 3, 44, 2},  // 44 Hz displaces by 0.5 % of 3 Hz
        Shaking{10, 20, 20, 3}, Shaking{0.1, 20, 20, 2}, Shaking{500, 0, 0, 12}}) {
    plant.highest_hz = c.highest_hz;
    Eigen::MatrixXd accel = Eigen::MatrixXd::Zero(kSamples, 2);
    for (Index i = 0; i < kSamples; ++i)
      for (const double hz : {c.slow_hz, c.fast_hz})
        accel(i, 0) += std::sin(2 * M_PI * hz * static_cast<double>(i) / kRate);
    const RecordSegment segment =
        make_segment(accel, kRate, Eigen::Vector2d::Constant(1e-3), {0.5, 46});
    EXPECT_EQ(steps_per_sample(plant, segment), c.steps)
        << c.highest_hz << " " << c.slow_hz << " " << c.fast_hz;
  }
}

/// A floor that moves with its ground is not displaced.
TEST(StepsPerSample, DoNotResolveTheMotionOfTheGround) {
  Eigen::MatrixXd accel(2001, 2);
  for (Index i = 0; i < accel.rows(); ++i) {
    const double ground = std::sin(2 * M_PI * 20 * static_cast<double>(i) / 100);
    accel.row(i) << ground + std::sin(2 * M_PI * 3 * static_cast<double>(i) / 100), ground;
  }
  Plant plant = test::SingleMass().plant();
  plant.highest_hz = 500;
  EXPECT_EQ(
      steps_per_sample(plant, make_segment(accel, 100, Eigen::Vector2d::Constant(1e-3), {0.5, 46})),
      2);
}

}  // namespace upsampled_test
}  // namespace framewatch::estimator
