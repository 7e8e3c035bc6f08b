// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/bias.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/small_building.h"

namespace framewatch::estimator {
namespace bias_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::Small;

constexpr int kAxis = 2;
constexpr double kSlope_mps3 = 0.05;
constexpr double kFrom_s = 8;

void add_ramp(MatrixXd& record, Index axis, double slope, double from_s) {
  for (Index i = 0; i < record.rows(); ++i)
    record(i, axis) += slope * std::max(static_cast<double>(i) / test::kRate_hz - from_s, 0.0);
}

/// Returns the record twice in a row: one record is too short to show slow motion.
MatrixXd twice(const MatrixXd& record) {
  return record.replicate(2, 1);
}

struct Ramped {
  Small small;
  Plant plant = small.plant();
  MatrixXd record = twice(small.record({}, 1));

  RecordSegment segment() const { return small.segments({record}).front(); }
};

TEST(Bias, FindsARampOnlyOnItsAxis) {
  constexpr double kSlopeTolerance = 0.05, kFromTolerance_s = 1.5;
  for (const double sign : {1.0, -1.0}) {
    Ramped r;
    add_ramp(r.record, kAxis, sign * kSlope_mps3, kFrom_s);
    const RecordSegment s = r.segment();
    for (Index a = 0; a < 6; ++a) {
      const std::optional<Ramp> ramp = find_ramp(r.plant, s, a);
      ASSERT_EQ(ramp.has_value(), a == kAxis) << a;
      if (!ramp) continue;
      EXPECT_NEAR(ramp->slope / (sign * kSlope_mps3), 1, kSlopeTolerance);
      EXPECT_NEAR(ramp->from_s, kFrom_s, kFromTolerance_s);
      EXPECT_GT(ramp->rms, 0);
    }
  }
}

TEST(Bias, IsNotFoundWithoutARamp) {
  const Ramped r;
  const RecordSegment s = r.segment();
  for (Index a = 0; a < 6; ++a) EXPECT_FALSE(find_ramp(r.plant, s, a)) << a;
}

TEST(Bias, ACommonMotionIsNoBias) {
  Ramped r;
  for (Index a = 0; a < 6; ++a) add_ramp(r.record, a, kSlope_mps3, kFrom_s);
  const RecordSegment s = r.segment();
  for (Index a = 0; a < 6; ++a) EXPECT_FALSE(find_ramp(r.plant, s, a)) << a;
}

TEST(Bias, AShortRecordShowsOnlyLargeDrifts) {
  constexpr Index kShort = 1000;
  for (const double slope_mps3 : {0.002, 0.2}) {
    Ramped r;
    add_ramp(r.record, kAxis, slope_mps3, 1);
    r.record.conservativeResize(kShort, Eigen::NoChange);
    EXPECT_EQ(find_ramp(r.plant, r.segment(), kAxis).has_value(), slope_mps3 > 0.1) << slope_mps3;
    EXPECT_FALSE(find_ramp(r.plant, r.segment(), kAxis + 1)) << slope_mps3;
  }
}

TEST(Bias, RemovingARampRestoresTheRecord) {
  constexpr double kRounding = 1e-9;
  Ramped r;
  const RecordSegment before = r.segment();
  add_ramp(r.record, kAxis, kSlope_mps3, kFrom_s);
  const RecordSegment ramped = r.segment();
  const RecordSegment after = without_ramp(ramped, kAxis, {kSlope_mps3, kFrom_s, 0});
  ASSERT_EQ(after.bins(), before.bins());
  EXPECT_EQ(after.first_bin, before.first_bin);
  EXPECT_LT((after.w - before.w).norm(), kRounding);
  EXPECT_LT((after.variance - before.variance).norm(), kRounding);
  EXPECT_GT((ramped.spectrum - before.spectrum).norm(), 0.01 * before.spectrum.norm());
  EXPECT_LT((after.spectrum - before.spectrum).norm(), kRounding * before.spectrum.norm());
  EXPECT_LT((after.accel - before.accel).norm(), kRounding * before.accel.norm());
}

}  // namespace bias_test
}  // namespace framewatch::estimator
