#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/plant.h"

namespace framewatch::estimator {

/// Returns the plant of a building whose axes cover some floors, have places in plan, or measure
/// forces. Unread motions become Plant::unread, and stories between measured floors are tied
/// (story_groups()). design: theta order of `structure`. Returns nullopt if a direction is measured
/// above the base but not at the base.
std::optional<Plant> partial_plant(const Structure& structure, const std::vector<SensorAxis>& axes,
                                   const Eigen::VectorXd& design, const BendingStiffness& bending,
                                   double rate_hz);

}  // namespace framewatch::estimator
