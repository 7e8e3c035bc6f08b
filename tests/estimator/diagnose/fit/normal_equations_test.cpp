// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/fit/law_tracks.h"
#include "estimator/diagnose/fit/normal_equations.h"
#include "estimator/diagnose/fit/unknowns.h"
#include "tests/estimator/diagnose/exact_record.h"

namespace framewatch::estimator {
namespace normal_equations_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::Small;

constexpr double kRelative = 1e-6;

struct Case {
  Small small;
  Plant plant = small.plant();
  std::vector<RecordSegment> segments = small.segments({small.record({}, 1), small.record({}, 2)});
  Fitter fitter{plant, segments, {}};
  Model model = test::true_model(small, plant);
  Linearised at = fitter.linearise(model, fitter.systems(model, {}, Forcing::measured));
};

MatrixXd whole_columns(const Linearised& at, std::size_t record) {
  const Columns& columns = at.columns[record];
  MatrixXd out(at.systems[record].residual.size(), columns.count());
  for (Index u = 0; u < out.cols(); ++u)
    out.col(u) = whole_column(*at.plant, at.systems[record], columns, u);
  return out;
}

/// Returns the columns with the end terms projected out, one by one.
MatrixXd without_ends_of(const Linearised& at, std::size_t record) {
  MatrixXd out = whole_columns(at, record);
  for (Index u = 0; u < out.cols(); ++u)
    out.col(u) = at.systems[record].weights->without_ends(out.col(u));
  return out;
}

MatrixXd ends_of(const Weights& weights) {
  const Index rows = 2 * weights.equations();
  MatrixXd out(rows * weights.bins(), weights.ends());
  for (Index b = 0; b < weights.bins(); ++b)
    out.middleRows(rows * b, rows) = weights.times_ends(b, RowMatrix::Identity(rows, rows));
  return out;
}

TEST(NormalEquations, MatchTheRowsWithoutEndTerms) {
  const Case c;
  const NormalEquations equations = normal_equations(c.at);
  MatrixXd normal = MatrixXd::Zero(c.at.columns[0].count(), c.at.columns[0].count());
  VectorXd gradient = VectorXd::Zero(normal.cols());
  double misfit = 0;
  for (std::size_t r = 0; r < 2; ++r) {
    const MatrixXd columns = without_ends_of(c.at, r);
    normal += columns.transpose() * columns;
    gradient += columns.transpose() * c.at.systems[r].rest;
    misfit += c.at.systems[r].misfit;
  }
  EXPECT_LT((equations.normal - normal).norm(), kRelative * normal.norm());
  EXPECT_LT((equations.gradient - gradient).norm(), kRelative * normal.norm());
  EXPECT_NEAR(equations.misfit, misfit, kRelative * misfit);
}

TEST(NormalEquations, SquareHoldsUnknownsResidualAndEnds) {
  const Case c;
  const std::vector<Index> kept{7, 0, 3};
  const MatrixXd square = square_of(c.at, 1, kept);
  const Whitened& system = c.at.systems[1];
  ASSERT_EQ(square.cols(), 4 + system.weights->ends());
  MatrixXd own(system.residual.size(), 4);
  const MatrixXd whole = whole_columns(c.at, 1);
  for (Index i = 0; i < 3; ++i) own.col(i) = whole.col(kept[static_cast<std::size_t>(i)]);
  own.col(3) = system.residual;
  const MatrixXd expected = own.transpose() * own;
  EXPECT_LT((square.topLeftCorner(4, 4) - expected).norm(), kRelative * expected.norm());
  EXPECT_TRUE(square.isApprox(square.transpose(), kRelative));
  EXPECT_EQ(square.bottomRightCorner(system.weights->ends(), system.weights->ends()),
            system.weights->ends_square());
  EXPECT_LT((square.bottomLeftCorner(system.weights->ends(), 4) -
             ends_of(*system.weights).transpose() * own)
                .norm(),
            kRelative * own.norm());
}

TEST(NormalEquations, EffectsAmongTheUnknownsHaveTheirPlaces) {
  Case c;
  c.model = test::with_effects(c.model, {test::cubic_spring(1, 1e11).modelled});
  const Linearised at =
      c.fitter.linearise(c.model, c.fitter.systems(c.model, {}, Forcing::measured));
  const MatrixXd whole = whole_columns(at, 0);
  const Index effect = whole.cols() - 1;
  ASSERT_LT(at.columns[0].direction[static_cast<std::size_t>(effect)], 0);
  ASSERT_GE(at.columns[0].direction.front(), 0);
  const std::vector<Index> kept{2, effect, 12, 5};  // before and after it
  MatrixXd own(whole.rows(), 5);
  for (Index i = 0; i < 4; ++i) own.col(i) = whole.col(kept[static_cast<std::size_t>(i)]);
  own.col(4) = at.systems[0].residual;
  const MatrixXd expected = own.transpose() * own;
  const MatrixXd square = square_of(at, 0, kept).topLeftCorner(5, 5);
  for (Index i = 0; i < 5; ++i)
    for (Index j = 0; j < 5; ++j)
      EXPECT_NEAR(square(i, j), expected(i, j),
                  kRelative * std::sqrt(expected(i, i) * expected(j, j)))
          << i << " " << j;
}

TEST(NormalEquations, EndsAreEliminated) {
  constexpr double kRounding = 1e-6;
  MatrixXd rows(6, 4);  // two unknowns, the residual, one end term
  rows << 1, 2, 3, 1, 0, 1, -1, 1, 2, 0, 1, 1, 1, 1, 1, 1, -1, 2, 0, 1, 3, 1, 2, 1;
  const VectorXd end = rows.col(3).normalized();
  rows.col(3) = end;
  const NormalEquations n = without_ends(rows.transpose() * rows, 1);
  const MatrixXd rest = rows.leftCols(3) - end * (end.transpose() * rows.leftCols(3));
  EXPECT_LT((n.normal - rest.leftCols(2).transpose() * rest.leftCols(2)).norm(), kRounding);
  EXPECT_LT((n.gradient - rest.leftCols(2).transpose() * rest.col(2)).norm(), kRounding);
  EXPECT_NEAR(n.misfit, rest.col(2).squaredNorm(), kRounding);
}

TEST(NormalEquations, PriorPullsTowardItsMean) {
  Case c;
  c.model.theta[0] = 1.2 * c.plant.design[0];
  c.model.gain[3] = -0.01;  // two deviations
  const Linearised at =
      c.fitter.linearise(c.model, c.fitter.systems(c.model, {}, Forcing::measured));
  EXPECT_GT(at.level, 1);
  for (std::size_t u = 0; u < at.unknowns.size(); ++u) {
    const Unknown& unknown = at.unknowns[u];
    const auto i = static_cast<Index>(u);
    EXPECT_NEAR(at.prior[i], at.level / (2 * unknown.sigma * unknown.sigma), 1e-9 * at.level);
    EXPECT_NEAR(at.pull[i], at.prior[i] * (unknown.center - value_of(c.model, unknown)),
                1e-9 * at.level);
  }
  EXPECT_LT(at.pull[0], 0);
  EXPECT_GE(c.at.level, 1);
}

TEST(BoundedStep, WithoutASolutionIsNotFinite) {
  Model model;
  model.theta = VectorXd::Ones(2);
  const std::vector<Unknown> unknowns{{Unknown::Kind::theta, 0}, {Unknown::Kind::theta, 1}};
  MatrixXd normal = MatrixXd::Identity(2, 2);
  EXPECT_LT((bounded_step(normal, Eigen::Vector2d(3, -4), model, unknowns) - Eigen::Vector2d(3, -4))
                .norm(),
            1e-12);
  normal(0, 1) = normal(1, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(bounded_step(normal, Eigen::Vector2d(3, -4), model, unknowns).allFinite());
}

}  // namespace normal_equations_test
}  // namespace framewatch::estimator
