// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/softened_fit.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/exact_record.h"

namespace framewatch::estimator {
namespace softened_fit_test {

using Eigen::MatrixXd;
using test::Small;

struct Case {
  Small small;
  Plant plant = small.plant();
  std::vector<RecordSegment> segments;
  Fitter fitter;
  FitResult linear;

  explicit Case(const MatrixXd& record)
      : segments(small.segments({record})),
        fitter(plant, segments, {}),
        linear(fitter.fit(initial_model(plant), {}, {})) {}

  /// Returns the largest relative error of a frame's stiffness.
  double error_of(const FitResult& fit) const {
    double out = 0;
    for (Eigen::Index f = 0; f < 4; ++f) {
      const Eigen::Index k = small.table.frame_stiffness(1, static_cast<int>(f));
      out = std::max(out, std::abs(fit.model.theta[k] / small.truth[k] - 1));
    }
    return out;
  }
};

TEST(SoftenedFit, AResonanceThatIsMissingShiftsTheStiffnessLess) {
  const Case c(Small().record(
      {test::with_values(EffectKind::tuned_mass_damper, test::node_place(3), {3000, 2.2, 0.05})},
      3));
  ASSERT_TRUE(c.linear.good);
  const FitResult soft = softened_fit(c.fitter, c.linear);
  ASSERT_TRUE(soft.good);
  EXPECT_GT(c.error_of(c.linear), 0.04);
  EXPECT_LT(c.error_of(soft), 0.5 * c.error_of(c.linear));
  // It is worse where the resonance acts, and its cost says so.
  EXPECT_GT(soft.cost, c.linear.cost);
}

TEST(SoftenedFit, AModelThatFitsStaysAsItIs) {
  const Case c(Small().record({}, 3));
  ASSERT_TRUE(c.linear.good);
  EXPECT_EQ(softened_fit(c.fitter, c.linear).model.theta, c.linear.model.theta);
}

TEST(SoftenedFit, WithoutAFitReturnsTheLast) {
  const Case c(Small().record({}, 3));
  FitResult broken = c.linear;
  broken.model.theta.setConstant(std::nan(""));
  broken.misfit = {1e9};
  EXPECT_EQ(softened_fit(c.fitter, broken).misfit, broken.misfit);
}

}  // namespace softened_fit_test
}  // namespace framewatch::estimator
