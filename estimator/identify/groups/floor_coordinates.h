#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// A floor's motion in coordinates of which the first are measured. Where the axes show all of it,
/// these are its own: the frames' of a flexible floor, the rigid motions of a rigid one. Else they
/// are what independent axes read, and the others carry no mass in common with them.
struct FloorCoordinates {
  Eigen::MatrixXd frames;  ///< frames x coordinates: the frames' motion
  int measured = 0;
  Eigen::MatrixXd from_axes;  ///< measured x all axes
};

/// story: 1..N. present: flags of the axes.
FloorCoordinates floor_coordinates(const Structure& structure, const std::vector<SensorAxis>& axes,
                                   const std::vector<std::uint8_t>& present, int story);

/// The base as a rigid body, as far as the axes show it: translations, rotation about the vertical.
/// All of these are measured; what no axis shows is taken as none.
FloorCoordinates base_coordinates(const Structure& structure, const std::vector<SensorAxis>& axes,
                                  const std::vector<std::uint8_t>& present);

/// Rotation of the base in the vertical planes along x and along y, rad per m of what its vertical
/// axes read, from the plane through them: rows over all axes, empty where they do not show it. A
/// rotation r moves a floor at the height h above the base by h r toward +x, +y.
std::array<Eigen::RowVectorXd, 2> base_rotations(const std::vector<SensorAxis>& axes,
                                                 const std::vector<std::uint8_t>& present);

}  // namespace framewatch::estimator
