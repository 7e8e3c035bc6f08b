#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/plant.h"

namespace framewatch::estimator {

/// design: theta order of `structure`. Where axes stand at places in plan or floors have none, the
/// plant of partial_plant(). Empty when the base is not measured in a direction that is measured
/// above it.
std::optional<Plant> make_plant(const Structure& structure, const std::vector<SensorAxis>& axes,
                                const Eigen::VectorXd& design, double rate_hz,
                                const BendingStiffness& bending = {});

}  // namespace framewatch::estimator
