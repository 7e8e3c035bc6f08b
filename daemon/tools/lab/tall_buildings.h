#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// A plane building of equal floors of 800 t, 3.5 m high: the stiffness falls from the base to a
/// third at the top, the lowest frequency is 10 Hz over the number of stories.
estimator::Structure tall_building(int stories);
/// Its design, 1.5 % damping proportional to stiffness.
Eigen::VectorXd tall_design(int stories);
/// A channel at the base and one on each of these floors.
std::vector<estimator::SensorAxis> floor_axes(const std::vector<int>& floors);

/// The same with two frames each way on rigid floors, and its design.
estimator::Structure tall_building_in_space(int stories);
Eigen::VectorXd tall_design_in_space(int stories);
/// Three channels at the base and on each of these floors: along both x-parallel frames and one
/// y-parallel.
std::vector<estimator::SensorAxis> floor_axes_in_space(const std::vector<int>& floors);

}  // namespace framewatch::daemon
