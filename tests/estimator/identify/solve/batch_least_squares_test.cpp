// SPDX-License-Identifier: MIT
#include "estimator/identify/solve/batch_least_squares.h"

#include <cmath>

#include <gtest/gtest.h>

#include "daemon/tools/lab/accuracy_trial.h"
#include "estimator/simulate/linear_response.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace batch_least_squares_test {

constexpr double kRate_hz = 100;
constexpr Eigen::Index kRows = 1000;

MotionHistory table1_motion() {
  return exact_motion(test::table1(), ParameterTable(test::table1()), test::table1_theta(),
                      daemon::oblique_motion(1), kRate_hz, kRows);
}

double largest_error(const Eigen::VectorXd& theta, const Eigen::VectorXd& truth) {
  return (theta.cwiseQuotient(truth).array() - 1).abs().maxCoeff();
}

TEST(BatchLeastSquares, IsExactOnExactMotion) {
  constexpr double kLimit = 1e-7;  // stiff floors are ill-conditioned: 1e-11 on the frames
  const ParameterTable table1(test::table1());
  EXPECT_LT(largest_error(batch_least_squares(test::table1(), table1, table1_motion()),
                          test::table1_theta()),
            kLimit);
  const Structure s = test::table2();
  const ParameterTable table2(s);
  const Eigen::VectorXd truth = test::table2_theta('d');
  const MotionHistory motion =
      exact_motion(s, table2, truth, daemon::oblique_motion(2), kRate_hz, kRows);
  EXPECT_LT(largest_error(batch_least_squares(s, table2, motion), truth), kLimit);
}

TEST(BatchLeastSquares, NoiseMakesEveryFrameSofterAsThePaperFinds) {
  // Paper, Figure 6: "most stiffness become smaller as the noise level increases".
  const ParameterTable table(test::table1());
  const Eigen::VectorXd truth = test::table1_theta();
  double last = 1;
  for (const double noise : {0.02, 0.05, 0.1}) {
    const Eigen::VectorXd theta = batch_least_squares(
        test::table1(), table, daemon::with_paper_noise(table1_motion(), kRate_hz, noise, 1));
    const double mean = theta.head(20).cwiseQuotient(truth.head(20)).mean();
    EXPECT_LT(mean, last);
    last = mean;
  }
  EXPECT_LT(last, 0.5);
}

TEST(BatchLeastSquares, FindsNothingAtRest) {
  const Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(kRows, test::table1().degrees_of_freedom());
  EXPECT_EQ(batch_least_squares(test::table1(), ParameterTable(test::table1()), {rest, rest, rest})
                .size(),
            0);
}

TEST(BatchLeastSquares, GivesNoValueForAFrameThatDoesNotMove) {
  // GIVEN a motion that leaves the y frames at rest: their normal equations are zero
  MotionHistory motion = table1_motion();
  const Structure s = test::table1();
  for (int story = 1; story <= s.stories; ++story)
    for (int f = s.n(); f < s.frames(); ++f)
      for (Eigen::MatrixXd* m : {&motion.accel_abs, &motion.vel_rel, &motion.disp_rel})
        m->col(s.dof(story, f)).setZero();
  EXPECT_EQ(batch_least_squares(s, ParameterTable(s), motion).size(), 0);
}

}  // namespace batch_least_squares_test
}  // namespace framewatch::estimator
