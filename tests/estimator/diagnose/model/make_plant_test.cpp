// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "daemon/tools/lab/few_sensors.h"
#include "estimator/diagnose/fit/unknowns.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/diagnose/model/make_plant.h"
#include "estimator/diagnose/model/model.h"
#include "estimator/structure/story_groups.h"
#include "tests/estimator/diagnose/small_building.h"

namespace framewatch::estimator {
namespace make_plant_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRounding = 1e-9;
constexpr double kRate_hz = 100;

/// Twenty stories with two frames in each direction, rigid floors, three channels on floors 5, 10,
/// 15 and 20.
struct InSpace {
  Structure structure = daemon::tall_building_in_space(20);
  VectorXd design = daemon::tall_design_in_space(20);
  std::vector<SensorAxis> axes = daemon::floor_axes_in_space({5, 10, 15, 20});

  Plant plant(const BendingStiffness& bending = {}) const {
    return *make_plant(structure, axes, design, kRate_hz, bending);
  }
};

SensorAxis at_place(const char* name, int story, double x_m, double y_m, double angle_rad) {
  SensorAxis out{name, story};
  out.direction = std::abs(std::cos(angle_rad)) > 0.7 ? Direction::x : Direction::y;
  out.plan = PlanPlace{x_m, y_m, angle_rad};
  return out;
}

TEST(PartialPlant, EveryMotionIsReadOrUnread) {
  InSpace building;
  // Floor 10 keeps its two translations.
  building.axes.erase(building.axes.begin() + 7);
  const Plant plant = building.plant();
  ASSERT_EQ(plant.equations(), 60);
  EXPECT_EQ(plant.read_equations(), 11);
  EXPECT_EQ(plant.axis_count(), static_cast<Index>(building.axes.size()));
  MatrixXd all(60, 60);
  all << plant.read, plant.unread;
  EXPECT_LT((all.transpose() * all - MatrixXd::Identity(60, 60)).norm(), kRounding);

  // Any motion differs from what the axes read of it only by unread motions.
  Random random(3);
  VectorXd moved(60), readings = VectorXd::Zero(plant.axis_count());
  for (double& value : moved) value = random.normal();
  for (std::size_t a = 0; a < building.axes.size(); ++a) {
    if (building.axes[a].story == 0) continue;
    const std::vector<double> weights = frame_weights(building.structure, building.axes[a]);
    readings[static_cast<Index>(a)] =
        Eigen::Map<const VectorXd>(weights.data(), 4)
            .dot(plant.constraint.middleRows(building.structure.dof(building.axes[a].story, 0), 4) *
                 moved);
  }
  const VectorXd of_axes = plant.motion.leftCols(plant.axis_count()) * readings;
  EXPECT_LT((plant.read.transpose() * (moved - of_axes)).norm(), kRounding * moved.norm());
}

TEST(PartialPlant, StoriesBetweenMeasuredFloorsShareFactors) {
  const InSpace building;
  const Plant plant = building.plant();
  ASSERT_EQ(plant.groups.size(), 16U);  // four groups of four frames
  const std::vector<Unknown> all = unknowns_of(plant, initial_model(plant), {0, 0, 0});
  ASSERT_EQ(all.size(), 32U);
  Model model = initial_model(plant);
  set_value(model, all[0], 1.5);
  int moved = 0;
  for (Index p = 0; p < model.theta.size(); ++p) {
    const double ratio = model.theta[p] / plant.design[p];
    EXPECT_TRUE(std::abs(ratio - 1) < kRounding || std::abs(ratio - 1.5) < kRounding);
    moved += std::abs(ratio - 1.5) < kRounding;
  }
  EXPECT_EQ(moved, 5);
  EXPECT_NEAR(value_of(model, all[0]), 1.5, kRounding);
}

TEST(PartialPlant, PlacesCoverMeasuredMotions) {
  const InSpace building;
  const Plant plant = building.plant();
  for (const CandidatePlace& place : candidate_places_of(plant, initial_model(plant))) {
    EXPECT_NE(place.kind, CandidatePlace::Kind::element);
    EXPECT_NE(place.kind, CandidatePlace::Kind::link);
    if (place.kind == CandidatePlace::Kind::node || place.kind == CandidatePlace::Kind::crossing) {
      EXPECT_EQ(place.place.story % 5, 0) << place.place.story;
    }
  }
}

TEST(PartialPlant, ABaseThatTurnsDrivesFramesByTheirPlaces) {
  InSpace building;
  const double width = line_position(building.structure, 1);
  std::erase_if(building.axes, [](const SensorAxis& axis) { return axis.story == 0; });
  building.axes.push_back(at_place("west", 0, 0, 0, 0));
  building.axes.push_back(at_place("north", 0, 0, width, 0));
  building.axes.push_back(at_place("across", 0, 0, 0, M_PI / 2));
  const Plant plant = building.plant();
  // One radian per s^2 around the south-west corner: x-parallel frames move by their distance.
  VectorXd readings = VectorXd::Zero(plant.building.axes());
  readings[plant.axis_count() - 2] = -width;
  const VectorXd ground = plant.ground * readings;
  for (const int story : {1, 7, 20}) {
    EXPECT_NEAR(ground[building.structure.dof(story, 0)], 0, kRounding);
    EXPECT_NEAR(ground[building.structure.dof(story, 1)], -width, kRounding);
    EXPECT_NEAR(ground[building.structure.dof(story, 2)], 0, kRounding);
    EXPECT_NEAR(ground[building.structure.dof(story, 3)], line_position(building.structure, 3),
                kRounding);
  }
}

TEST(PartialPlant, AMeasuredForceIsAnInputButNoMotion) {
  Structure structure = daemon::tall_building(3);
  std::vector<SensorAxis> axes = daemon::floor_axes({1, 2, 3});
  axes.erase(axes.begin());  // the base rests
  SensorAxis force{"shaker", 2, Direction::x, 0};
  force.is_force = true;
  axes.push_back(force);
  const auto plant = make_plant(structure, axes, daemon::tall_design(3), kRate_hz);
  ASSERT_TRUE(plant);
  EXPECT_TRUE(plant->is_input(3));
  EXPECT_TRUE(plant->is_force(3));
  EXPECT_EQ(plant->motion.col(3).norm(), 0);
  EXPECT_LT((plant->push.col(3) + VectorXd::Unit(3, 1)).norm(), kRounding);
  EXPECT_EQ(plant->read_equations(), 3);
}

TEST(PartialPlant, FramesBendAsDesigned) {
  BendingStiffness bending;
  bending.base_nmprad = {4e12, 0};
  const Plant plant = InSpace().plant(bending);
  const Model model = initial_model(plant);
  ASSERT_EQ(model.effects.size(), 1U);
  EXPECT_EQ(model.effects[0].form, LawForm::bending);
  EXPECT_NEAR(model.effects[0].parameters[0].plain() * 4e12, 1, kRounding);
  EXPECT_EQ(model.effects[0].place.direction, Direction::x);
}

TEST(PartialPlant, NeedsTheBaseInEveryMeasuredDirection) {
  InSpace building;
  std::erase_if(building.axes, [](const SensorAxis& axis) {
    return axis.story == 0 && axis.direction == Direction::y;
  });
  EXPECT_FALSE(make_plant(building.structure, building.axes, building.design, kRate_hz));
}

}  // namespace make_plant_test
}  // namespace framewatch::estimator
