// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/law/law_parameter.h"

#include <cmath>

#include <gtest/gtest.h>

#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/model/make_plant.h"
#include "tests/estimator/diagnose/effect_of.h"
#include "tests/estimator/diagnose/other_buildings.h"

namespace framewatch::estimator {
namespace model_test {

using Eigen::VectorXd;
using test::Small;

TEST(Model, AParameterMayBeStoredAsALogarithm) {
  LawParameter parameter = test::parameter_of(std::log(250.0));
  EXPECT_DOUBLE_EQ(parameter.plain(), std::log(250.0));
  parameter.logarithmic = true;
  EXPECT_NEAR(parameter.plain(), 250, 1e-9);
}

TEST(Model, BeginsWithTheDesignAndTheDeclaredDelays) {
  Small small;
  small.axes[2].delay = 0.004;
  const Model model = initial_model(small.plant());
  EXPECT_EQ(model.theta, small.design);
  EXPECT_EQ(model.mass_change, VectorXd::Zero(4));
  EXPECT_EQ(model.gain, VectorXd::Zero(6));
  EXPECT_EQ(model.clock_s, 0.004 * VectorXd::Unit(6, 2));
  EXPECT_TRUE(model.effects.empty());
  EXPECT_TRUE(model.free_gain.empty() && model.free_clock.empty());
}

TEST(Model, ALawsValuesAreSharedOnesThenRecordOnes) {
  ModelEffect effect = test::effect_of(LawForm::changing, test::frame_place(0), {-5e5}, {3, 2});
  effect.record_parameters.push_back({test::parameter_of(9), test::parameter_of(1)});
  effect.deformation = 0.01;
  effect.rate = 0.2;
  EXPECT_TRUE(effect.element_law());
  EXPECT_EQ(effect.law(0).p, (std::vector<double>{-5e5, 3, 2}));
  EXPECT_EQ(effect.law(1).p, (std::vector<double>{-5e5, 9, 1}));
  EXPECT_EQ(effect.law(2).p, (std::vector<double>{-5e5}));
  EXPECT_EQ(effect.law(1).form, LawForm::changing);
  EXPECT_EQ(effect.law(1).deformation, 0.01);
  EXPECT_EQ(effect.law(1).rate, 0.2);
  effect.parameters[0].logarithmic = true;
  effect.parameters[0].value = std::log(7.0);
  EXPECT_NEAR(effect.law(0).p[0], 7, 1e-12);
}

TEST(Model, AnElementIsFoundByItsPlace) {
  const Small small;
  const Plant plant = small.plant();
  for (int f = 0; f < 4; ++f)
    EXPECT_EQ(element_of(plant, test::frame_place(f)), plant.table.frame_stiffness(1, f));
  EXPECT_EQ(element_of(plant, test::panel_place(0)), plant.table.panel_stiffness(1, 0));
}

TEST(Model, FramesMeetAtACrossing) {
  const Structure grid = test::table2();  // four lines in each direction
  ASSERT_EQ(frames_at(grid, 0), (std::vector<int>{0, 4}));
  EXPECT_EQ(frames_at(grid, 3), (std::vector<int>{0, 7}));
  EXPECT_EQ(frames_at(grid, 4), (std::vector<int>{1, 4}));
  EXPECT_EQ(frames_at(grid, 15), (std::vector<int>{3, 7}));
  Structure plane = Small::one_story();
  plane.frames_y.clear();
  EXPECT_EQ(frames_at(plane, 1), (std::vector<int>{1}));
  plane.frames_y.swap(plane.frames_x);
  EXPECT_EQ(frames_at(plane, 1), (std::vector<int>{1}));
}

TEST(Model, ANodesDirectionIsItsCoordinate) {
  const Small small;
  const Plant plant = small.plant();
  for (int f = 0; f < 4; ++f) EXPECT_EQ(node_direction(plant, 1, f), VectorXd::Unit(4, f));
}

/// On a floor that moves as one body: the motion of a node for each of the three coordinates.
TEST(Model, ANodesDirectionOnARigidFloorIsItsShare) {
  constexpr double kRounding = 1e-12;
  Small small = test::rigid_small();
  small.axes.erase(small.axes.begin() + 3);  // three sensors cannot show if it flexes
  const auto plant = make_plant(small.structure, small.axes, small.design, test::kRate_hz);
  ASSERT_TRUE(plant);
  ASSERT_EQ(plant->equations(), 3);
  // Coordinates are orthonormal under the floor's mass.
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  for (int f = 0; f < 4; ++f) {
    const VectorXd share = node_direction(*plant, 1, f);
    square += small.structure.frame_mass(1, f) * share * share.transpose();
  }
  EXPECT_LT((square - Eigen::Matrix3d::Identity()).norm(), kRounding);
}

}  // namespace model_test
}  // namespace framewatch::estimator
