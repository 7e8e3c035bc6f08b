// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/noise_corner.h"

#include <cmath>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/gap.h"
#include "estimator/diagnose/fit/measured_deformation.h"
#include "tests/estimator/diagnose/flicker.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace noise_corner_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Result of fit_noise_corner() for the linear model's fit to records.
struct Coloured {
  test::Recorded recorded;
  FitResult now;
  double misfit_before;
  bool is;

  explicit Coloured(const std::vector<MatrixXd>& records)
      : recorded(records), now(recorded.linear()), misfit_before(misfit()) {
    is = fit_noise_corner(recorded.fitter, recorded.segments, now);
  }
  double misfit() const { return now.total_misfit() / recorded.fitter.expected(now.model); }
};

TEST(NoiseCorner, IsFoundIfNothingElseIsMissing) {
  constexpr double kCorner_hz = 20;
  const Coloured c(test::with_flicker(test::records_with({}, {1, 2}), kCorner_hz));
  EXPECT_GT(c.misfit_before, 1.5);
  ASSERT_TRUE(c.is);
  EXPECT_NEAR(c.recorded.segments.front().corner_hz / kCorner_hz, 1, 0.35);
  EXPECT_NEAR(c.misfit(), 1, 0.1);
}

TEST(NoiseCorner, IsNotFoundInWhiteNoise) {
  const Coloured c(test::records_with({}, {1, 2}));
  EXPECT_FALSE(c.is);
  EXPECT_EQ(c.recorded.segments.front().corner_hz, 0);
}

TEST(NoiseCorner, DoesNotStandInForAMissingEffect) {
  for (const double gain : {1.05, 1.2}) {
    std::vector<MatrixXd> records = test::records_with({}, {1, 2});
    for (MatrixXd& record : records) record.col(1) *= gain;
    const Coloured c(records);
    ASSERT_GT(c.misfit_before, 1.1);
    EXPECT_FALSE(c.is) << gain;
    EXPECT_EQ(c.misfit(), c.misfit_before);
    EXPECT_EQ(c.recorded.segments.front().corner_hz, 0);
  }
}

TEST(NoiseCorner, WeighsBinsOfLowFrequencyLess) {
  const test::Recorded recorded(test::records_with({}, {1}));
  RecordSegment segment = recorded.segments.front();
  const Model model = initial_model(recorded.plant);
  const VectorXd white = bin_noise(model, segment, 3);
  segment.corner_hz = segment.w[3] / (2 * M_PI);
  EXPECT_NEAR((bin_noise(model, segment, 3) - 2 * white).norm(), 0, 1e-12 * white.norm());
  EXPECT_LT(with_model_error(recorded.plant, {segment}, 1).front().corner_hz,
            0.1 * segment.corner_hz)
      << "the model's own error is white";
}

}  // namespace noise_corner_test
}  // namespace framewatch::estimator
