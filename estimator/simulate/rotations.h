#pragma once

#include "estimator/simulate/linear_model.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// base_rocking and frame_bending along one direction: replaces the frames' deformations in
/// model.linear by those beside the rotations, and adds the rotational springs. The rotations have
/// no inertia and follow the elastic moments (docs/effects.md); a stiffness <= 0 means no such
/// rotation.
void add_rotations(const Structure& structure, const ParameterTable& table, Direction direction,
                   double base_stiffness, double floor_stiffness, LinearModel& model);

}  // namespace framewatch::estimator
