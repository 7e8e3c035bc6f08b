#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// A random building: 1 to 6 stories, 1 to 4 frames each way, spans, masses and
/// stiffnesses that differ from frame to frame, damping not proportional to the stiffness.
struct RandomBuilding {
  estimator::Structure structure;
  Eigen::VectorXd truth;  ///< theta order, SI
};

RandomBuilding random_building(std::uint64_t seed);

}  // namespace framewatch::daemon
