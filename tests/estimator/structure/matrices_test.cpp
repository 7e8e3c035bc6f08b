// SPDX-License-Identifier: MIT
#include "estimator/structure/matrices.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "estimator/structure/natural_frequencies.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace matrices_test {

Structure one_frame(int stories, bool along_x) {
  Structure s;
  s.stories = stories;
  (along_x ? s.frames_x : s.frames_y) = {"a"};
  s.story_height.assign(static_cast<std::size_t>(stories), 3.0);
  s.node_mass.assign(static_cast<std::size_t>(stories), 2.0);
  return s;
}

TEST(Matrices, PlaneBuildingIsTheShearBuildingOfTheTextbook) {
  for (const bool along_x : {true, false}) {
    const Structure s = one_frame(3, along_x);
    ASSERT_TRUE(problems(s).empty());
    const ParameterTable table(s);
    Eigen::VectorXd theta(6);
    theta << 300, 200, 100, 3, 2, 1;
    Eigen::Matrix3d k;
    k << 500, -200, 0, -200, 300, -100, 0, -100, 100;
    const Matrices m = assemble(s, table, theta);
    EXPECT_EQ(m.stiffness, k);
    EXPECT_EQ(m.damping, k / 100);
    EXPECT_EQ(m.mass, Eigen::Vector3d(2, 2, 2));
  }
}

TEST(Matrices, FrequenciesOfAUniformShearBuildingAreTheClosedForm) {
  const int stories = 4;
  const Structure s = one_frame(stories, true);
  const ParameterTable table(s);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  theta.head(stories).setConstant(800);
  const std::vector<double> found = natural_frequencies_hz(s, table, theta);
  for (int r = 1; r <= stories; ++r) {
    const double w = 2 * std::sqrt(800 / 2.0) * std::sin((2 * r - 1) * M_PI / (4 * stories + 2));
    EXPECT_NEAR(found[static_cast<std::size_t>(r - 1)], w / (2 * M_PI), 1e-10);
  }
}

TEST(Matrices, RigidFloorHasThreeMotionsOrthonormalUnderItsMass) {
  Structure s = test::table2();
  s.floor = FloorModel::rigid;
  s.node_mass[3] = 21e3;  // eccentric
  const Eigen::MatrixXd r = floor_constraint(s);
  ASSERT_EQ(r.cols(), 6);
  const ParameterTable table(s);
  const Matrices m = assemble(s, table, Eigen::VectorXd::Ones(table.size()));
  const Eigen::MatrixXd gram = r.transpose() * m.mass.asDiagonal() * r;
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(6, 6)).norm(), 1e-13);
}

TEST(Matrices, RigidPlanesHaveFewerMotions) {
  Structure line = one_frame(2, true);
  line.floor = FloorModel::rigid;
  EXPECT_EQ(floor_constraint(line).cols(), 2);  // one translation per floor
  line.frames_x = {"a", "b"};
  line.span_y = {5};
  line.node_mass.assign(4, 2.0);
  EXPECT_EQ(floor_constraint(line).cols(), 4);  // and a rotation
}

TEST(Matrices, FlexibleFloorsAreUnconstrained) {
  const Structure s = test::table1();
  EXPECT_EQ(floor_constraint(s), Eigen::MatrixXd::Identity(20, 20));
}

TEST(Matrices, VeryStiffPanelsHaveTheFrequenciesOfRigidFloors) {
  const Structure flexible = test::table1();
  Structure rigid = flexible;
  rigid.floor = FloorModel::rigid;
  const ParameterTable table(flexible), rigid_table(rigid);
  Eigen::VectorXd theta = test::table1_theta();
  Eigen::VectorXd rigid_theta(rigid_table.size());
  for (int i = 0; i < rigid_table.size(); ++i)
    rigid_theta[i] = theta[*table.find(rigid_table[i].name)];
  for (int story = 1; story <= 5; ++story) theta[table.panel_stiffness(story, 0)] = 1e12;
  const auto stiff = natural_frequencies_hz(flexible, table, theta);
  const auto exact = natural_frequencies_hz(rigid, rigid_table, rigid_theta);
  ASSERT_EQ(exact.size(), 15u);
  for (std::size_t i = 0; i < exact.size(); ++i) EXPECT_NEAR(stiff[i], exact[i], 1e-5 * exact[i]);
}

TEST(Matrices, LowestFrequencyOfALargeBuildingIsRight) {
  for (const FloorModel floor : {FloorModel::flexible, FloorModel::rigid}) {
    Structure s = test::table2();
    s.floor = floor;
    s.stories = 40;
    s.story_height.assign(40, 3.0);
    const std::vector<double> masses = s.node_mass;
    while (static_cast<int>(s.node_mass.size()) < s.nodes())
      s.node_mass.insert(s.node_mass.end(), masses.begin(), masses.end());
    s.node_mass.resize(static_cast<std::size_t>(s.nodes()));
    const ParameterTable table(s);
    Eigen::VectorXd theta = Eigen::VectorXd::Constant(table.size(), 2500);
    for (Eigen::Index i = 0; i < theta.size(); i += 3) theta[i] *= 1.3;
    const double all = natural_frequencies_hz(s, table, theta).front();
    EXPECT_NEAR(lowest_frequency_hz(s, table, theta) / all, 1, 1e-9);
  }
}

}  // namespace matrices_test
}  // namespace framewatch::estimator
