#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/structure/group_design.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// A linear building in coordinates of which the first are measured: those of the base, of which
/// nothing else is asked, measured forces, rotations of the base in vertical planes, rad/s^2, then
/// those of the measured floors, then inner ones. A force is a coordinate whose "acceleration" it
/// is: less its lever on the others in the mass matrix. Absolute motion. Its stiffness is K =
/// constant + sum over parameters of x_p K_p, damping likewise, with x_p = 1 at the design.
/// docs/equations.md, groups of stories.
struct ReducedBuilding {
  int inputs = 0;             ///< coordinates of the base, forces, rotations of the base
  int rotations = 0;          ///< of the inputs, the last ones (base_rotations())
  int measured = 0;           ///< coordinates that are measured, inputs among them
  Eigen::MatrixXd from_axes;  ///< measured x axes
  /// Where the measured coordinates of each measured floor begin, behind the inputs; then their
  /// end.
  std::vector<int> floors;
  /// Inner coordinates that move together, in their order: where each set begins, then the end.
  std::vector<int> sets;
  Eigen::MatrixXd mass, constant_stiffness, constant_damping;
  /// Motion of the frames at the base, then at every floor, by the coordinates.
  Eigen::MatrixXd frames;
  /// By parameter: K_p or C_p; `damping` says which. Zero where another one stands for it.
  std::vector<Eigen::MatrixXd> parts;
  std::vector<std::uint8_t> damping;
  /// By parameter: the one whose factor it has, mostly itself; of groups between which a floor is
  /// no longer measured the first one.
  std::vector<int> same_as;

  int size() const { return static_cast<int>(mass.rows()); }
  int rows() const { return measured - inputs; }
};

/// The building as the axes flagged in `present` see it. table: of groups. rows() is 0 where the
/// base is not measured in a direction that is measured above, and while a force is missing. Groups
/// between which a floor is not present become one, unless keep_groups. Inner floors that move
/// together, more than kMaxInner of them, are described by their lowest modes with the ends held.
/// Source: Craig and Bampton, AIAA J. 6 (1968), 1313.
ReducedBuilding reduced_building(const Structure& structure, const std::vector<SensorAxis>& axes,
                                 const ParameterTable& table, const GroupDesign& design,
                                 const std::vector<std::uint8_t>& present,
                                 bool keep_groups = false);

/// Whether the base is measured in every direction that is measured above it, or rests while every
/// force is known; and something is measured above it.
bool shows_groups(const Structure& structure, const std::vector<SensorAxis>& axes,
                  const std::vector<std::uint8_t>& present);

}  // namespace framewatch::estimator
