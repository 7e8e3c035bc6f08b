#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// The paper's Table 1: 5 stories, 1x1 bay, 50 parameters. Damping 2 % at the first mode,
/// proportional to the stiffness, here and below.
estimator::Structure table1();
Eigen::VectorXd table1_theta();

/// The paper's Table 2: 2 stories, 3x3 bays, 68 parameters.
estimator::Structure table2();
/// variant 'b' flexible, 'c' basic, 'd' stiff floors.
Eigen::VectorXd table2_theta(char variant);

/// A sensor on every degree of freedom, story-major as Structure::dof (names F1-y1), then the base
/// axes the structure needs (F0-x, F0-y).
std::vector<estimator::SensorAxis> full_sensor_axes(const estimator::Structure& structure);

}  // namespace framewatch::daemon
