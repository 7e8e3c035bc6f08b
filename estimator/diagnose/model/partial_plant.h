#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/plant.h"

namespace framewatch::estimator {

/// The plant of a building with axes on some floors or at places in plan, and with measured forces:
/// what they do not read is Plant::unread, stories between measured floors are tied
/// (story_groups()). design: theta order of `structure`. Empty where the base is not measured in a
/// direction that is measured above it.
std::optional<Plant> partial_plant(const Structure& structure, const std::vector<SensorAxis>& axes,
                                   const Eigen::VectorXd& design, const BendingStiffness& bending,
                                   double rate_hz);

}  // namespace framewatch::estimator
