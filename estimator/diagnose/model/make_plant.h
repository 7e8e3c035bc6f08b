// SPDX-License-Identifier: MIT
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

/// Returns the plant of a building, or nullopt if a direction is measured above the base but not at
/// the base. design: theta order of `structure`. Uses partial_plant() if axes have places in plan,
/// measure forces or leave floors without axes, and if frames bend.
std::optional<Plant> make_plant(const Structure& structure, const std::vector<SensorAxis>& axes,
                                const Eigen::VectorXd& design, double rate_hz,
                                const BendingStiffness& bending = {});

}  // namespace framewatch::estimator
