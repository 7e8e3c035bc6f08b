// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "estimator/identify/regressors/regressor_tuning.h"
#include "estimator/identify/solve/story_solver.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "estimator/simulate/random.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace story_solver_test {

constexpr int kBlocks = 20;
constexpr int kBlockRows = 3;
constexpr int kSettle = 1;
/// Rounding error times condition numbers of a few thousand.
constexpr double kLimit = 1e-10;

/// Random deformations through rows and sums, and the same normal equations, dense.
struct Bench {
  /// still: front position of floor 0 whose deformation never moves; -1: all move.
  Bench(const Structure& s, const Eigen::VectorXd& theta, int still)
      : structure(s),
        table(s),
        layout(structure, table),
        axes(test::full_sensor_axes(s)),
        deformations(structure, layout, axes),
        tuning(structure, layout, deformations, options, matched_triple(100), HighPass(0.3, 100),
               theta),
        filter(tuning, layout, kSettle),
        sums(layout, kBlocks, kBlockRows),
        solver(layout),
        gram(Eigen::MatrixXd::Zero(layout.unknowns() + 1, layout.unknowns() + 1)) {
    DeformationSet set = deformations.make_set();
    std::fill(set.known.begin(), set.known.end(), std::uint8_t{1});
    Random random(7);
    for (int t = 0; t < kBlocks * kBlockRows - 1; ++t) {  // one short of a closed window
      for (double& v : set.values) v = random.normal();
      if (still >= 0) set.values[static_cast<std::size_t>(still)] = 0;
      filter.push(set);
      sums.push(filter);
      add_dense();
      sums.maintain(nullptr);
    }
    for (double& v : set.values) v = random.normal();
    if (still >= 0) set.values[static_cast<std::size_t>(still)] = 0;
    filter.push(set);
    sums.push(filter);
    add_dense();
  }
  void add_dense() {
    const int last = layout.unknowns();
    for (int f = 0; f < layout.floors(); ++f) {
      const int stride = padded(layout.front(f)), front = layout.front(f);
      for (int r = 0; r < filter.count(f); ++r) {
        Eigen::VectorXd h = Eigen::VectorXd::Zero(last + 1);
        for (int i = 0; i < front - 1; ++i)
          h[f * layout.own() + i] = filter.rows(f)[r * stride + i];
        h[last] = filter.rows(f)[r * stride + front - 1];
        gram += h * h.transpose();
      }
    }
  }

  Structure structure;
  ParameterTable table;
  FloorLayout layout;
  std::vector<SensorAxis> axes;
  Deformations deformations;
  EstimatorOptions options;
  RegressorTuning tuning;
  RegressorFilter filter;
  SlidingGram sums;
  StorySolver solver;
  Eigen::MatrixXd gram;  ///< unknowns, response
};

/// Compares with a dense solution that holds unknown `fixed` at 1; -1: holds none.
void expect_dense(const Structure& s, const Eigen::VectorXd& theta, double prior, int fixed) {
  Bench b(s, theta, fixed);
  const int n = b.layout.unknowns();
  NoiseCompensation noise(b.layout);
  noise.update(b.filter, b.sums.window(), 0);  // subtracts nothing
  b.solver.factor(b.sums.window(), std::vector<double>(static_cast<std::size_t>(n), prior),
                  std::vector<double>(static_cast<std::size_t>(n), 1.0), noise);
  std::vector<int> kept;
  for (int u = 0; u < n; ++u) {
    EXPECT_EQ(b.solver.usable(u), u != fixed) << u;
    if (u != fixed) kept.push_back(u);
  }
  const Eigen::MatrixXd a = b.gram.topLeftCorner(n, n)(kept, kept) +
                            prior * Eigen::MatrixXd::Identity(n - (fixed >= 0), n - (fixed >= 0));
  Eigen::VectorXd right = b.gram.col(n)(kept);
  right.array() += prior;
  const Eigen::LDLT<Eigen::MatrixXd> dense(a);
  const Eigen::VectorXd x = dense.solve(right);
  const Eigen::MatrixXd inverse = dense.solve(Eigen::MatrixXd::Identity(a.rows(), a.cols()));

  Random random(9);
  const int columns = 8;
  std::vector<double> many(static_cast<std::size_t>(n * columns));
  for (double& v : many) v = random.normal();
  Eigen::MatrixXd wanted(a.rows(), columns);
  for (std::size_t k = 0; k < kept.size(); ++k)
    for (int c = 0; c < columns; ++c)
      wanted(static_cast<Eigen::Index>(k), c) =
          many[static_cast<std::size_t>(kept[k] * columns + c)];
  wanted = dense.solve(wanted).eval();
  StoryFactor factor(b.layout);
  b.solver.swap_factor(factor);
  InverseDiagonal inverse_diagonal(b.layout);
  std::vector<double> diagonal(static_cast<std::size_t>(n));
  for (int f = 0; f < b.layout.floors(); ++f) factor.forward(f, many.data(), columns);
  for (int f = b.layout.floors() - 1; f >= 0; --f) {
    factor.backward(f, many.data(), columns);
    inverse_diagonal.step(factor, f, diagonal.data());
  }
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const auto u = static_cast<std::size_t>(kept[k]);
    const auto i = static_cast<Eigen::Index>(k);
    EXPECT_NEAR(b.solver.solution()[u], x[i], kLimit * (1 + std::abs(x[i])));
    EXPECT_NEAR(diagonal[u] / inverse(i, i), 1, kLimit) << u;
    EXPECT_NEAR(b.solver.information()[u] / b.gram(kept[k], kept[k]), 1, kLimit);
    for (int c = 0; c < columns; ++c)
      EXPECT_NEAR(many[u * columns + static_cast<std::size_t>(c)], wanted(i, c),
                  kLimit * wanted.cwiseAbs().maxCoeff());
  }
  if (fixed >= 0) {
    EXPECT_EQ(b.solver.solution()[static_cast<std::size_t>(fixed)], 1);
  }
  const double energy = b.gram(n, n);
  EXPECT_NEAR(b.solver.response_energy() / energy, 1, kLimit);
  const double residual =
      (a * x).dot(x) - 2 * right.dot(x) + energy + prior * static_cast<double>(n);
  EXPECT_NEAR(b.solver.residual_energy(), residual, kLimit * (energy + prior * n));
}

TEST(StorySolver, MatchesTheDenseSolution) {
  expect_dense(test::table1(), test::table1_theta(), 0, -1);
  expect_dense(test::table2(), test::table2_theta('c'), 0, -1);
}

TEST(StorySolver, MatchesTheDenseSolutionWithAPrior) {
  expect_dense(test::table1(), test::table1_theta(), 3.5, -1);
  expect_dense(test::table2(), test::table2_theta('c'), 3.5, -1);
}

TEST(StorySolver, AnUnobservableUnknownLeavesTheRestUnaffected) {
  expect_dense(test::table1(), test::table1_theta(), 0, 2);
  expect_dense(test::table2(), test::table2_theta('c'), 0, 5);
}

}  // namespace story_solver_test
}  // namespace framewatch::estimator
