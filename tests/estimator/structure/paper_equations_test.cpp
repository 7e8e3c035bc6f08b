// SPDX-License-Identifier: MIT
// Compares the assembled matrices with the paper's appendix, coded as printed except for its
// misprints (docs/equations.md). Nothing here uses elements.
#include <vector>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"
#include "estimator/structure/matrices.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace paper_equations_test {

constexpr double kRounding = 1e-13;

/// 2 stories, n = 2, m = 4: n and m differ, so that a confusion shows.
Structure oblong() {
  Structure s = test::table2();
  s.frames_x = {"y1", "y2"};
  s.span_y = {3.5};
  s.node_mass.assign(static_cast<std::size_t>(s.nodes()), 0.0);
  for (std::size_t i = 0; i < s.node_mass.size(); ++i)
    s.node_mass[i] = 1000.0 + 37.0 * static_cast<double>(i * i);
  return s;
}

Eigen::VectorXd random_vector(int size, std::uint64_t seed) {
  Random random(seed);
  Eigen::VectorXd out(size);
  for (double& v : out) v = 1 + random.uniform();
  return out;
}

/// One quantity per (story, frame line): 0 at the ground and outside the plan.
struct Appendix {
  const Structure& s;
  const ParameterTable& table;
  const Eigen::VectorXd& y;  ///< displacements, or velocities with `damping`
  const Eigen::VectorXd& theta;
  bool damping;

  double parameter(int index) const { return theta[index + (damping ? table.elements() : 0)]; }
  double u(int i, int l) const { return i == 0 ? 0.0 : y[s.dof(i, l)]; }
  double v(int i, int j) const { return i == 0 ? 0.0 : y[s.dof(i, s.n() + j)]; }
  /// (A1)-(A4)
  double q_wx(int i, int l) const {
    if (i > s.stories) return 0;
    return parameter(table.frame_stiffness(i, l)) * (u(i, l) - u(i - 1, l));
  }
  double q_wy(int i, int j) const {
    if (i > s.stories) return 0;
    return parameter(table.frame_stiffness(i, s.n() + j)) * (v(i, j) - v(i - 1, j));
  }
  bool panel(int j, int l) const { return j >= 0 && j < s.m() - 1 && l >= 0 && l < s.n() - 1; }
  double lx(int j) const { return s.span_x[static_cast<std::size_t>(j)]; }
  double ly(int l) const { return s.span_y[static_cast<std::size_t>(l)]; }
  double g(int i, int j, int l) const {
    return parameter(table.panel_stiffness(i, l * (s.m() - 1) + j));
  }
  /// (A5)-(A10)
  double gamma(int i, int j, int l) const {
    return (u(i, l + 1) - u(i, l)) / ly(l) + (v(i, j + 1) - v(i, j)) / lx(j);
  }
  double q_fx(int i, int j, int l) const {
    return panel(j, l) ? g(i, j, l) * lx(j) * gamma(i, j, l) : 0;
  }
  double q_fy(int i, int j, int l) const {
    return panel(j, l) ? g(i, j, l) * ly(l) * gamma(i, j, l) : 0;
  }
  /// The left sides of (A11) and (A12) without the inertia.
  Eigen::VectorXd forces() const {
    Eigen::VectorXd out(s.degrees_of_freedom());
    for (int i = 1; i <= s.stories; ++i) {
      for (int l = 0; l < s.n(); ++l) {
        double sum = q_wx(i, l) - q_wx(i + 1, l);
        for (int j = 0; j < s.m() - 1; ++j) sum += q_fx(i, j, l - 1) - q_fx(i, j, l);
        out[s.dof(i, l)] = sum;
      }
      for (int j = 0; j < s.m(); ++j) {
        double sum = q_wy(i, j) - q_wy(i + 1, j);
        for (int l = 0; l < s.n() - 1; ++l) sum += q_fy(i, j - 1, l) - q_fy(i, j, l);
        out[s.dof(i, s.n() + j)] = sum;
      }
    }
    return out;
  }
};

void expect_the_appendix(const Structure& s) {
  const ParameterTable table(s);
  const Eigen::VectorXd theta = 1e6 * random_vector(table.size(), 3);
  const Eigen::VectorXd y = random_vector(s.degrees_of_freedom(), 4);
  const Matrices m = assemble(s, table, theta);
  const Eigen::VectorXd elastic = Appendix{s, table, y, theta, false}.forces();
  const Eigen::VectorXd damping = Appendix{s, table, y, theta, true}.forces();
  EXPECT_LT((m.stiffness * y - elastic).norm(), kRounding * elastic.norm());
  EXPECT_LT((m.damping * y - damping).norm(), kRounding * damping.norm());
}

TEST(PaperEquations, ForcesOfTheAppendixAreTheMatricesTimesMotion) {
  expect_the_appendix(test::table1());
  expect_the_appendix(test::table2());
  expect_the_appendix(oblong());
}

TEST(PaperEquations, MassOfAFrameIsTheSumOfItsNodes) {  // (A13), (A14)
  const Structure s = oblong();
  const ParameterTable table(s);
  const Matrices m = assemble(s, table, Eigen::VectorXd::Ones(table.size()));
  const auto node = [&](int i, int l, int j) {
    return s.node_mass[static_cast<std::size_t>(((i - 1) * 2 + l) * 4 + j)];
  };
  for (int i = 1; i <= 2; ++i) {
    for (int l = 0; l < 2; ++l)
      EXPECT_DOUBLE_EQ(m.mass[s.dof(i, l)],
                       node(i, l, 0) + node(i, l, 1) + node(i, l, 2) + node(i, l, 3));
    for (int j = 0; j < 4; ++j)
      EXPECT_DOUBLE_EQ(m.mass[s.dof(i, 2 + j)], node(i, 0, j) + node(i, 1, j));
  }
}

TEST(PaperEquations, FrameStiffnessCouplesTheFloorsBelowAndAbove) {  // (8), (9) as corrected
  const Structure s = oblong();
  const ParameterTable table(s);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  theta[table.frame_stiffness(2, 3)] = 7;
  const Eigen::MatrixXd k = assemble(s, table, theta).stiffness;
  const int below = s.dof(1, 3), above = s.dof(2, 3);
  EXPECT_EQ(k(below, below), 7);
  EXPECT_EQ(k(above, above), 7);
  EXPECT_EQ(k(below, above), -7);
  EXPECT_DOUBLE_EQ(k.norm(), 14);
}

}  // namespace paper_equations_test
}  // namespace framewatch::estimator
