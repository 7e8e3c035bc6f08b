// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/plant.h"

#include <gtest/gtest.h>

#include "estimator/diagnose/model/make_plant.h"
#include "estimator/simulate/linear_response.h"
#include "tests/estimator/diagnose/other_buildings.h"

namespace framewatch::estimator {
namespace plant_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::Small;

constexpr double kRounding = 1e-9;

TEST(Plant, EquationsMatchTheStructure) {
  const Small small;
  const Plant plant = small.plant();
  EXPECT_EQ(plant.equations(), 4);
  EXPECT_EQ(plant.element_count(), 5);
  EXPECT_EQ(plant.axis_count(), 6);
  EXPECT_FALSE(plant.stiff_floors);
  EXPECT_FALSE(plant.prescribed);
  EXPECT_EQ(plant.design, small.design);
  for (int f = 0; f < 4; ++f) {
    EXPECT_NEAR(plant.mass[f], small.structure.frame_mass(1, f), kRounding);
    EXPECT_LT((plant.motion.row(f) - VectorXd::Unit(6, f).transpose()).norm(), kRounding);
    const Index base = small.structure.direction(f) == Direction::x ? 4 : 5;
    EXPECT_LT((plant.ground.row(f) - VectorXd::Unit(6, base).transpose()).norm(), kRounding);
    EXPECT_LT((plant.building.sense.row(plant.table.frame_stiffness(1, f)).transpose() -
               (VectorXd::Unit(6, f) - VectorXd::Unit(6, base)))
                  .norm(),
              kRounding);
  }
  EXPECT_NEAR(plant.highest_hz,
              natural_frequencies_hz(small.structure, small.table, small.design).back(), kRounding);
}

TEST(Plant, ExactMotionBalancesItsForces) {
  constexpr double kTolerance = 1e-9;  // of the inertia
  const Small small;
  const Plant plant = small.plant();
  const MotionHistory motion = exact_motion(small.structure, small.table, small.truth,
                                            test::oblique_motion(3), test::kRate_hz, 300);
  const Index elements = plant.element_count(), instants = motion.accel_abs.rows();
  const auto of_axes = [&](const MatrixXd& sensors) {
    MatrixXd out = MatrixXd::Zero(6, instants);  // relative motion: zero for the base
    out.topRows(4) = sensors.leftCols(4).transpose();
    return out;
  };
  const MatrixXd inertia = plant.building.mass * of_axes(motion.accel_abs);
  const MatrixXd force =
      small.truth.head(elements).asDiagonal() * plant.building.sense * of_axes(motion.disp_rel) +
      MatrixXd(small.truth.tail(elements).asDiagonal() * plant.building.sense *
               of_axes(motion.vel_rel));
  EXPECT_LT((inertia + plant.building.act * force).norm(), kTolerance * inertia.norm());
}

TEST(Plant, UnreadMotionsFollowExceptAtTheBase) {
  for (std::size_t missing = 0; missing < 6; ++missing) {
    Small small;
    small.axes.erase(small.axes.begin() + static_cast<long>(missing));
    const auto plant = make_plant(small.structure, small.axes, small.design, test::kRate_hz);
    ASSERT_EQ(plant.has_value(), missing < 4) << missing;
    if (plant) {
      EXPECT_EQ(plant->read_equations(), 3) << missing;
    }
  }
}

TEST(Plant, ARigidFloorWithEverySensorHasEveryCoordinate) {
  constexpr double kStiffEnough = 100;  // times the stiffest frame
  const Small small = test::rigid_small();
  const Plant plant = small.plant();
  EXPECT_TRUE(plant.stiff_floors);
  EXPECT_EQ(plant.structure.floor, FloorModel::flexible);
  EXPECT_EQ(plant.equations(), 4);
  for (int f = 0; f < 4; ++f) {
    EXPECT_EQ(plant.design[plant.table.frame_stiffness(1, f)],
              small.design[small.table.frame_stiffness(1, f)]);
    EXPECT_EQ(plant.design[plant.table.frame_damping(1, f)],
              small.design[small.table.frame_damping(1, f)]);
  }
  EXPECT_GT(plant.design[plant.table.panel_stiffness(1, 0)],
            kStiffEnough * small.design.head(4).maxCoeff());
  EXPECT_GT(plant.design[plant.table.panel_damping(1, 0)], 0);
  // Its steps are those for the modes of the rigid floor.
  EXPECT_NEAR(plant.highest_hz,
              natural_frequencies_hz(small.structure, small.table, small.design).back(), kRounding);
}

TEST(Plant, ARigidFloorWithThreeSensorsHasThreeCoordinates) {
  for (std::size_t missing = 0; missing < 4; ++missing) {
    Small small = test::rigid_small();
    small.axes.erase(small.axes.begin() + static_cast<long>(missing));
    const Plant plant = small.plant();
    EXPECT_FALSE(plant.stiff_floors);
    EXPECT_EQ(plant.equations(), 3);
    EXPECT_EQ(plant.element_count(), 4);
    // The three coordinates determine three readings.
    MatrixXd seen(3, 3);
    for (Index a = 0; a < 3; ++a) {
      const SensorAxis& axis = plant.axes[static_cast<std::size_t>(a)];
      seen.row(a) = plant.constraint.row(plant.structure.dof(axis.story, axis.frame));
    }
    EXPECT_LT((seen * plant.motion.leftCols(3) - MatrixXd::Identity(3, 3)).norm(), kRounding)
        << missing;
  }
}

TEST(Plant, AForceAxisPushesAtItsNode) {
  const Small small;
  const Plant before = small.plant();
  const Plant plant = with_force_axis(before, {"actuator", 1, Direction::y, 3});
  EXPECT_EQ(plant.axis_count(), 7);
  EXPECT_EQ(plant.equations(), 4);
  EXPECT_EQ(plant.push.col(6), -VectorXd::Unit(4, 3));
  EXPECT_TRUE(plant.push.leftCols(6).isZero(0));
  EXPECT_TRUE(plant.building.mass.col(6).isZero(0));
  EXPECT_TRUE(plant.building.sense.col(6).isZero(0));
  EXPECT_EQ(plant.building.mass.leftCols(6), before.building.mass);
  EXPECT_EQ(plant.building.variance.size(), 7);
  EXPECT_EQ(plant.highest_hz, before.highest_hz);
  for (Index a = 0; a < 7; ++a) {
    EXPECT_EQ(plant.is_force(a), a == 6) << a;
    EXPECT_EQ(plant.is_input(a), a >= 4) << a;
  }
  const Plant twice = with_force_axis(plant, {"second", 1, Direction::x, 0});
  EXPECT_EQ(twice.push.col(6), plant.push.col(6));
  EXPECT_EQ(twice.push.col(7), -VectorXd::Unit(4, 0));
}

}  // namespace plant_test
}  // namespace framewatch::estimator
