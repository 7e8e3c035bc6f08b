// SPDX-License-Identifier: MIT
#include "estimator/structure/matrices.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace elements_test {

/// Rounding of sums of a few dozen products, relative to the largest term.
constexpr double kRounding = 1e-14;

Eigen::MatrixXd stiffness_of(const Structure& s, const Element& e) {
  Eigen::VectorXd b = Eigen::VectorXd::Zero(s.degrees_of_freedom());
  for (const auto& [dof, value] : e.b) b[dof] += value;
  return b * b.transpose();
}

/// Returns a theta with 1 for every panel stiffness and 0 elsewhere.
Eigen::VectorXd panels_alone(const ParameterTable& table) {
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  for (int i = 0; i < table.size(); ++i)
    if (table[i].kind == ParameterKind::panel_stiffness) theta[i] = 1;
  return theta;
}

TEST(Elements, FollowTheStiffnessHalfOfTheta) {
  const Structure s = test::table2();
  const ParameterTable table(s);
  const std::vector<Element> all = elements(s, table);
  ASSERT_EQ(all.size(), static_cast<std::size_t>(table.elements()));
  for (int i = 0; i < table.elements(); ++i) {
    const Element& e = all[static_cast<std::size_t>(i)];
    EXPECT_EQ(e.stiffness, i);
    EXPECT_EQ(e.story, table[i].story);
    EXPECT_EQ(e.frame, table[i].frame);
    EXPECT_EQ(e.panel, table[i].panel);
  }
}

TEST(Elements, PanelIsTheHessianOfItsShearEnergy) {
  Structure s = test::table1();
  s.stories = 1;
  s.story_height = {4.0};
  s.node_mass.resize(4);
  const double lx = s.span_x[0], ly = s.span_y[0];
  // gamma = (u2 - u1)/Ly + (v2 - v1)/Lx; energy G Lx Ly gamma^2 / 2.
  const Eigen::Vector4d gamma(-1 / ly, 1 / ly, -1 / lx, 1 / lx);
  const Eigen::Matrix4d hessian = lx * ly * gamma * gamma.transpose();
  const Element panel = elements(s, ParameterTable(s)).back();
  ASSERT_EQ(panel.panel, 0);
  EXPECT_LT((stiffness_of(s, panel) - hessian).norm(), kRounding * hessian.norm());
}

TEST(Elements, RigidBodyMotionOfAFloorStrainsNoPanel) {
  const Structure s = test::table2();
  const ParameterTable table(s);
  const Eigen::MatrixXd k = assemble(s, table, panels_alone(table)).stiffness;
  Structure rigid = s;
  rigid.floor = FloorModel::rigid;
  const Eigen::MatrixXd motions = floor_constraint(rigid);
  ASSERT_EQ(motions.cols(), 6);
  EXPECT_LT((k * motions).norm(), kRounding * k.norm() * motions.norm());
}

TEST(Elements, FloorOfFourByFourFramesHasRankFive) {
  const Structure s = test::table2();
  const ParameterTable table(s);
  const Eigen::MatrixXd k = assemble(s, table, panels_alone(table)).stiffness;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(k.topLeftCorner(8, 8));
  const Eigen::VectorXd values = solver.eigenvalues();
  EXPECT_LT(values[2], kRounding * 10 * values[7]);  // three rigid-body motions
  EXPECT_GT(values[0], -kRounding * 10 * values[7]);
  EXPECT_GT(values[3], 0.01 * values[7]);
  EXPECT_EQ(k.topRightCorner(8, 8).norm(), 0);
}

TEST(Elements, BuildingIsTheSumOfItsElements) {
  const Structure s = test::table1();
  const ParameterTable table(s);
  const Eigen::VectorXd theta = test::table1_theta();
  const Matrices m = assemble(s, table, theta);
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(20, 20), c = k;
  for (const Element& e : elements(s, table)) {
    k += theta[e.stiffness] * stiffness_of(s, e);
    c += theta[e.stiffness + table.elements()] * stiffness_of(s, e);
  }
  EXPECT_LT((m.stiffness - k).norm(), kRounding * k.norm());
  EXPECT_LT((m.damping - c).norm(), kRounding * c.norm());
  EXPECT_LT((m.stiffness - m.stiffness.transpose()).norm(), kRounding * k.norm());
  EXPECT_GT(m.stiffness.ldlt().vectorD().minCoeff(), 0);
}

}  // namespace elements_test
}  // namespace framewatch::estimator
