// SPDX-License-Identifier: MIT
#include "estimator/simulate/linear_response.h"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "daemon/tools/lab/accuracy_trial.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/matrices.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace exact_motion_test {

constexpr double kRate_hz = 100;
constexpr double kRounding = 1e-9;

TEST(ExactMotion, SatisfiesTheEquationOfMotionAtEveryInstant) {
  const Structure s = test::table2();
  const ParameterTable table(s);
  const Eigen::VectorXd truth = test::table2_theta('c');
  const MotionHistory m = exact_motion(s, table, truth, daemon::oblique_motion(3), kRate_hz, 600);
  const Matrices matrices = assemble(s, table, truth);
  const Eigen::MatrixXd left = m.accel_abs * matrices.mass.asDiagonal();
  const Eigen::MatrixXd right = m.vel_rel * matrices.damping + m.disp_rel * matrices.stiffness;
  EXPECT_LT((left + right).norm(), kRounding * left.norm());
  EXPECT_EQ(m.accel_abs.row(0).norm(), 0);
}

TEST(ExactMotion, IsTheResponseWithoutAntiAliasFilter) {
  const Structure s = test::table1();
  const ParameterTable table(s);
  const PlanMotion motion = daemon::oblique_motion(4);
  ResponseOptions options;
  options.anti_alias = false;
  const Response response = linear_response(s, table, test::table1_theta(), motion, options, 4);
  const MotionHistory m = exact_motion(s, table, test::table1_theta(), motion, kRate_hz, 401);
  EXPECT_LT((response.accel_abs.leftCols(m.accel_abs.cols()) - m.accel_abs).norm(),
            1e-6 * m.accel_abs.norm());
}

TEST(BandNoise, HasUnitRmsAndNothingOutsideItsBand) {
  constexpr Eigen::Index kRows = 1000;
  Random random(9);
  const Eigen::VectorXd noise = band_noise(kRows, kRate_hz, 1, 20, random);
  EXPECT_NEAR(noise.squaredNorm() / kRows, 1, 1e-12);
  const auto share = [&](double hz) {
    std::complex<double> sum = 0;
    for (Eigen::Index i = 0; i < kRows; ++i)
      sum += noise[i] * std::polar(1.0, -2 * M_PI * hz * static_cast<double>(i) / kRate_hz);
    return std::abs(sum) / kRows;
  };
  for (const double outside_hz : {0.0, 0.5, 0.9, 20.1, 35.0}) EXPECT_LT(share(outside_hz), 1e-12);
  double inside = 0;
  for (double hz = 1; hz < 20; hz += 1) inside += share(hz) * share(hz);
  EXPECT_GT(inside, 0);
  Random same(9);
  EXPECT_EQ(noise, band_noise(kRows, kRate_hz, 1, 20, same));
}

}  // namespace exact_motion_test
}  // namespace framewatch::estimator
