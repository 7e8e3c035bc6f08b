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

TEST(StepsPerSample, ResolveTheHighestMode) {
  struct Case {
    double highest_hz, rate_hz;
    int steps;
  };
  Plant plant = test::SingleMass().plant();
  for (const Case& c : {Case{0.1, 100, 2}, Case{10, 100, 3}, Case{10, 50, 6}, Case{20.1, 100, 7},
                        Case{500, 100, 12}}) {
    plant.highest_hz = c.highest_hz;
    EXPECT_EQ(steps_per_sample(plant, c.rate_hz), c.steps) << c.highest_hz << " " << c.rate_hz;
  }
}

}  // namespace upsampled_test
}  // namespace framewatch::estimator
