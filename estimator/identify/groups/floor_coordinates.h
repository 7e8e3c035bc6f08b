// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The motion of a floor in coordinates of which the first are measured. If the axes show the whole
/// motion, these are the floor's natural coordinates: its frames on a flexible floor, its rigid
/// motions on a rigid one. Otherwise they are the readings of independent axes, and the other
/// coordinates share no mass with them.
struct FloorCoordinates {
  Eigen::MatrixXd frames;  ///< motion of the frames, frames x coordinates
  int measured = 0;
  Eigen::MatrixXd from_axes;  ///< measured x all axes
};

/// Returns the coordinates of a floor. story: 1..N. present: flags of the axes.
FloorCoordinates floor_coordinates(const Structure& structure, const std::vector<SensorAxis>& axes,
                                   const std::vector<std::uint8_t>& present, int story);

/// Returns the coordinates of the base as a rigid body: translations and rotation about the
/// vertical. All of them count as measured; a motion that no axis shows is taken as zero.
FloorCoordinates base_coordinates(const Structure& structure, const std::vector<SensorAxis>& axes,
                                  const std::vector<std::uint8_t>& present);

/// Returns the rotations of the base in the vertical planes along x and along y, rad per m of the
/// readings of its vertical axes, from the plane through them. Each row covers all axes and is
/// empty if they do not show the rotation. A rotation r moves a floor at height h above the base by
/// h r toward +x or +y.
std::array<Eigen::RowVectorXd, 2> base_rotations(const std::vector<SensorAxis>& axes,
                                                 const std::vector<std::uint8_t>& present);

}  // namespace framewatch::estimator
