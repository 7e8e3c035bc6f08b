// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/residual.h"

#include <cmath>
#include <complex>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace residual_test {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

constexpr double kNoise = 4;  // |difference|^2 of every bin

/// Two records with gaps made by hand: noise of known size, and whatever a test adds.
struct Case {
  test::Recorded recorded{test::records_with({}, {1, 2})};
  std::vector<Gap> gaps;

  explicit Case(double times_noise = 1) {
    Random random(7);
    for (const RecordSegment& s : recorded.segments) {
      Gap gap;
      gap.difference = MatrixXcd::Zero(recorded.plant.axis_count(), s.bins());
      gap.noise = MatrixXd::Zero(recorded.plant.axis_count(), s.bins());
      for (Index a = 0; a < 4; ++a)
        for (Index b = 0; b < s.bins(); ++b) {
          gap.noise(a, b) = kNoise;
          gap.difference(a, b) =
              times_noise * std::sqrt(kNoise / 2) * std::complex(random.normal(), random.normal());
        }
      gaps.push_back(gap);
    }
  }
  const Plant& plant() const { return recorded.plant; }
  const std::vector<RecordSegment>& segments() const { return recorded.segments; }
};

TEST(ResidualCorrelation, OfNoiseIsNearZero) {
  constexpr double kOff = 0.05;
  const Case c, twice(2);
  const ResidualCorrelation r =
      residual_correlation(c.plant(), c.segments(), twice.gaps, c.gaps, 0);
  ASSERT_GT(r.lag_s.size(), 10);
  EXPECT_NEAR(r.before_level, 2, 2 * kOff);
  EXPECT_NEAR(r.after_level, 1, kOff);
  EXPECT_FALSE(is_patterned(r.before_outside, r.lag_s.size())) << "louder noise is noise";
  EXPECT_FALSE(is_patterned(r.after_outside, r.lag_s.size()));
  EXPECT_LT(r.after.cwiseAbs().mean(), r.white_band);
}

TEST(ResidualCorrelation, OfAResonanceRingsAtItsPeriod) {
  constexpr double kSize = 5;
  const Case c;
  Case rings;
  const Index bins = c.segments()[1].bins(), middle = bins / 3;
  for (Index b = middle - 3; b <= middle + 3; ++b)
    rings.gaps[1].difference.col(b).head(4) *= kSize * 3;
  const ResidualCorrelation r =
      residual_correlation(c.plant(), c.segments(), rings.gaps, c.gaps, 1);
  EXPECT_TRUE(is_patterned(r.before_outside, r.lag_s.size()));
  EXPECT_FALSE(is_patterned(r.after_outside, r.lag_s.size()));
  // A peak at a third of the band comes back at six lags, each half the inverse bandwidth.
  EXPECT_GT(r.before[5], 3 * r.white_band);
  EXPECT_LT(r.before[2], -3 * r.white_band);
}

TEST(ResidualCorrelation, IsEmptyWithoutRecordsOrRuns) {
  const Case c;
  EXPECT_EQ(residual_correlation(c.plant(), c.segments(), c.gaps, c.gaps, 2).lag_s.size(), 0);
  EXPECT_EQ(residual_correlation(c.plant(), c.segments(), {}, c.gaps, 0).lag_s.size(), 0);
  const ResidualCorrelation r = residual_correlation(c.plant(), c.segments(), c.gaps, {}, 0);
  EXPECT_GT(r.before.size(), 0);
  EXPECT_EQ(r.after.size(), 0) << "the run with the effects diverges";
}

TEST(ResidualSpectrum, GivesDensities) {
  constexpr double kOff = 0.1;
  const Case c, twice(2);
  const ResidualSpectrum r = residual_spectrum(c.plant(), c.segments(), twice.gaps, c.gaps, 1);
  const RecordSegment& s = c.segments()[1];
  const double density = std::sqrt(2 * kNoise / (s.rate_hz * static_cast<double>(s.intervals())));
  ASSERT_GT(r.hz.size(), 10);
  EXPECT_GE(r.hz[0], s.w[0] / (2 * M_PI));
  for (Index b = 0; b < r.hz.size(); ++b) EXPECT_NEAR(r.noise[b] / density, 1, 1e-9) << b;
  EXPECT_NEAR(std::sqrt(r.before.squaredNorm() / r.noise.squaredNorm()), 2, 2 * kOff);
  EXPECT_NEAR(std::sqrt(r.after.squaredNorm() / r.noise.squaredNorm()), 1, kOff);
  // The measured power in the band comes back from the densities.
  const double step_hz = r.hz[1] - r.hz[0];
  const double power = 2 * s.spectrum.topRows(4).squaredNorm() /
                       (4 * std::pow(static_cast<double>(s.intervals()), 2));
  EXPECT_NEAR(step_hz * r.measured.squaredNorm() / power, 1, kOff);
}

TEST(FloorGaps, AreSharesOfTheFloorsMotion) {
  const Case c, twice(2);
  const std::vector<FloorGap> floors = floor_gaps(c.plant(), c.segments(), twice.gaps, c.gaps, 0);
  ASSERT_EQ(floors.size(), 1U);
  double before = 0, floor = 0;
  for (std::size_t r = 0; r < 2; ++r) {
    const double power = c.segments()[r].spectrum.topRows(4).squaredNorm();
    before += std::sqrt(twice.gaps[r].difference.squaredNorm() / power) / 2;
    floor += std::sqrt(c.gaps[r].noise.sum() / power) / 2;
  }
  EXPECT_EQ(floors[0].story, 1);
  EXPECT_NEAR(floors[0].before, before, 1e-12);
  EXPECT_NEAR(floors[0].floor, floor, 1e-12);
  EXPECT_LT(floors[0].after, floors[0].before);
  EXPECT_TRUE(std::isnan(floor_gaps(c.plant(), c.segments(), c.gaps, {}, 0).front().after));
}

TEST(IsPatterned, AllowsForChance) {
  EXPECT_FALSE(is_patterned(3, 60));
  EXPECT_FALSE(is_patterned(6, 60));
  EXPECT_TRUE(is_patterned(7, 60));
  EXPECT_FALSE(is_patterned(0, 1));
}

}  // namespace residual_test
}  // namespace framewatch::estimator
