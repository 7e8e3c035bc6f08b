#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/simulate/simulated_building.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// What moves a building from outside, as its axes show it: the base's translations and rotation
/// about the vertical, its rocking as the base's verticals show it (docs/equations.md),
/// forces. What no axis shows counts as none.
struct MeasuredInputs {
  Inputs inputs;
  Eigen::MatrixXd from_axes;       ///< inputs x all axes: m/s^2, rad/s^2 or N of what the axes read
  std::vector<Eigen::Index> used;  ///< axes that show any
};
/// present: flags of the axes.
MeasuredInputs measured_inputs(const Structure& structure, const std::vector<SensorAxis>& axes,
                               const std::vector<std::uint8_t>& present);

}  // namespace framewatch::estimator
