// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "estimator/simulate/random.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::study {

/// A building as it is, and as its engineer believes it to be.
struct StudyBuilding {
  std::string kind;
  estimator::Structure truth;     ///< with the true masses
  Eigen::VectorXd theta;          ///< true stiffness and damping
  estimator::Structure believed;  ///< masses off by 1 %
  Eigen::VectorXd design;         ///< stiffness off by 5 %
  double design_damping_ratio = 0.01;
  std::vector<estimator::SensorAxis> axes;
  std::vector<double> gain_error;   ///< of each axis, 0.5 %
  std::vector<double> clock_error;  ///< s, 0.25 ms

  estimator::ParameterTable table() const { return estimator::ParameterTable(truth); }
};

/// Returns the kinds of building: 2story_1x1, 2story_3x3, 5story_1x1 (stories, bays).
const std::vector<std::string>& building_kinds();

/// Returns a random building. The standard deviations of its errors are scaled by `tolerance`.
StudyBuilding random_building(const std::string& kind, estimator::FloorModel floor,
                              estimator::Random& random, double tolerance = 1);

/// Returns the engineer's belief as a configuration file.
std::string config_toml(const StudyBuilding& building, double rate_hz);

}  // namespace framewatch::study
