// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

// Buildings of the accuracy studies. Parameters are in theta order, SI.
namespace framewatch::daemon {

/// The paper's Table 1: 5 stories, 1x1 bay, 50 parameters. The damping of this and the next
/// building is 2 % at the first mode, proportional to the stiffness.
estimator::Structure table1();
Eigen::VectorXd table1_theta();

/// The paper's Table 2: 2 stories, 3x3 bays, 68 parameters.
estimator::Structure table2();
/// variant: 'b' flexible, 'c' basic, 'd' stiff floors.
Eigen::VectorXd table2_theta(char variant);

/// Returns a sensor on every degree of freedom, story-major as Structure::dof (names F1-y1), then
/// the base axes that the structure needs (F0-x, F0-y).
std::vector<estimator::SensorAxis> full_sensor_axes(const estimator::Structure& structure);

/// A plane building of equal floors of 800 t, 3.5 m high. The stiffness falls from the base to a
/// third at the top; the lowest frequency is 10 Hz over the number of stories.
estimator::Structure tall_building(int stories);
/// Its design, with 1.5 % damping proportional to stiffness.
Eigen::VectorXd tall_design(int stories);
/// Returns a channel at the base and one on each of these floors.
std::vector<estimator::SensorAxis> floor_axes(const std::vector<int>& floors);

/// The tall building with two frames each way on rigid floors, and its design.
estimator::Structure tall_building_in_space(int stories);
Eigen::VectorXd tall_design_in_space(int stories);
/// Returns three channels at the base and on each of these floors: along both x-parallel frames and
/// one y-parallel frame.
std::vector<estimator::SensorAxis> floor_axes_in_space(const std::vector<int>& floors);

/// A random building: 1 to 6 stories, 1 to 4 frames each way, spans, masses and stiffnesses that
/// differ from frame to frame, damping not proportional to the stiffness.
struct RandomBuilding {
  estimator::Structure structure;
  Eigen::VectorXd truth;
};

RandomBuilding random_building(std::uint64_t seed);

}  // namespace framewatch::daemon
