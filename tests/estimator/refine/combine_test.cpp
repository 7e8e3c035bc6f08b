// SPDX-License-Identifier: MIT
#include "estimator/refine/combine.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace combine_test {

Refinement estimate(const Eigen::Vector2d& theta, const Eigen::Matrix2d& covariance) {
  Refinement r;
  r.status = RefineStatus::converged;
  r.theta = theta;
  r.covariance = covariance;
  r.std_error = covariance.diagonal().cwiseSqrt();
  r.bound = r.std_error;
  r.misfit_ratio = 1;
  return r;
}

Eigen::Matrix2d matrix(double a, double b, double c) {
  Eigen::Matrix2d m;
  m << a, b, b, c;
  return m;
}

const Eigen::Vector2d kTruth{2e6, 3e3};

TEST(Combine, OneEstimateIsItself) {
  const Refinement one = estimate(kTruth, matrix(4e8, 1e4, 9));
  EXPECT_EQ(combine({one}).theta, one.theta);
  EXPECT_EQ(combine({one}).covariance, one.covariance);
}

TEST(Combine, ManyEstimatesHaveTheErrorThatTheyState) {
  Eigen::Matrix2d root;
  root << 2e4, 0, 1.5, 2.6;
  const Eigen::Matrix2d covariance = root * root.transpose();
  Random random(1);
  constexpr int kRuns = 2000, kPieces = 5;
  double square = 0, stated = 0;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<Refinement> pieces;
    for (int i = 0; i < kPieces; ++i) {
      // Every other piece knows half as much.
      const double times = i % 2 == 0 ? 1 : std::sqrt(2.0);
      const Eigen::Vector2d off =
          times * (root * Eigen::Vector2d(random.normal(), random.normal()));
      pieces.push_back(estimate(kTruth + off, times * times * covariance));
    }
    const Refinement all = combine(pieces);
    square += std::pow((all.theta[0] - kTruth[0]) / all.std_error[0], 2);
    stated += all.covariance(0, 0);
  }
  // 3 whole pieces and 2 halves: a quarter of the variance. Where chance sets pieces further apart
  // than they state, it grows: by the mean of max(1, c / 8), with c of chi-squared of 8 freedoms.
  constexpr double kGrowth = 1.195;
  EXPECT_NEAR(stated / kRuns, kGrowth * covariance(0, 0) / 4, 0.03 * covariance(0, 0) / 4);
  EXPECT_NEAR(square / kRuns, 0.9, 0.1);
}

TEST(Combine, EstimatesThatDifferMakeTheErrorLarger) {
  const Eigen::Matrix2d covariance = matrix(4e8, 0, 9);
  const Eigen::Vector2d apart{1e6, 0};  // 50 standard errors to each side
  const Refinement all =
      combine({estimate(kTruth - apart, covariance), estimate(kTruth + apart, covariance)});
  EXPECT_NEAR(all.theta[0], kTruth[0], 1);
  EXPECT_NEAR(all.std_error[0], 1e6 / std::sqrt(2), 1e3);
}

TEST(Combine, LeavesOutWhatKnowsNothing) {
  const Eigen::Matrix2d covariance = matrix(4e8, 0, 9);
  const Refinement good = estimate(kTruth, covariance);
  Refinement quiet;
  quiet.status = RefineStatus::quiet;
  Refinement endless = good;
  endless.covariance(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(combine({quiet, good, endless}).theta, good.theta);
  EXPECT_EQ(combine({quiet, quiet}).status, RefineStatus::quiet);
  const Refinement two = combine({quiet, good, endless, good});
  EXPECT_NEAR(two.std_error[0], good.std_error[0] / std::sqrt(2), 1e-6 * good.std_error[0]);
}

}  // namespace combine_test
}  // namespace framewatch::estimator
