// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/structure/group_design.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// A linear building in coordinates of which the first are measured: those of the base, which are
/// inputs only, measured forces, rotations of the base in vertical planes, rad/s^2, then those of
/// the measured floors. Inner coordinates follow. A force enters as a coordinate whose
/// "acceleration" it is: minus its lever on the others in the mass matrix. Motion is absolute. The
/// stiffness is K = constant + sum over parameters of x_p K_p, with x_p = 1 at the design; the
/// damping is formed likewise. docs/equations.md, groups of stories.
struct ReducedBuilding {
  int inputs = 0;             ///< coordinates of the base, forces and rotations of the base
  int rotations = 0;          ///< number of rotations, the last inputs (base_rotations())
  int measured = 0;           ///< measured coordinates, including the inputs
  Eigen::MatrixXd from_axes;  ///< measured x axes
  /// The first coordinate of each measured floor, after the inputs, then the end.
  std::vector<int> floors;
  /// The first coordinate of each set of inner coordinates that move together, then the end.
  std::vector<int> sets;
  Eigen::MatrixXd mass, constant_stiffness, constant_damping;
  /// Motion of the frames at the base, then at every floor, by the coordinates.
  Eigen::MatrixXd frames;
  /// By parameter: K_p, or C_p where `damping` is set. Zero if another parameter stands for it.
  std::vector<Eigen::MatrixXd> parts;
  std::vector<std::uint8_t> damping;
  /// By parameter: the one whose factor it has, usually itself. Groups that merge, because the
  /// floor between them is not measured, share the factor of the first one.
  std::vector<int> same_as;

  int size() const { return static_cast<int>(mass.rows()); }
  int rows() const { return measured - inputs; }
};

/// Returns the building as the axes flagged in `present` show it. table: of a building in groups.
/// rows() is 0 while a force is missing, or if a direction is measured above the base but not
/// there. Groups merge if the floor between them is not present, unless keep_groups. More than
/// kMaxInner inner floors that move together are described by their lowest modes with the ends
/// held. Source: Craig and Bampton, AIAA J. 6 (1968), 1313.
ReducedBuilding reduced_building(const Structure& structure, const std::vector<SensorAxis>& axes,
                                 const ParameterTable& table, const GroupDesign& design,
                                 const std::vector<std::uint8_t>& present,
                                 bool keep_groups = false);

/// Returns true if something is measured above the base, and the base is measured in the same
/// directions or is at rest while every force is known.
bool shows_groups(const Structure& structure, const std::vector<SensorAxis>& axes,
                  const std::vector<std::uint8_t>& present);

}  // namespace framewatch::estimator
