// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The design of the building as designed parameters.
struct GroupDesign {
  /// Parameters of every story, in the order of ParameterTable(structure), SI.
  Eigen::VectorXd theta;
  BendingStiffness bending_nmprad{};
};

/// Returns the parameters of the groups in table order, SI. Stories of a group act in series,
/// frames in parallel.
Eigen::VectorXd group_parameters(const Structure& structure, const ParameterTable& table,
                                 const GroupDesign& design);

/// Returns the parameters of every story, in the order of ParameterTable(structure), for the
/// groups' parameters `of_groups`. Each story keeps its share of the design.
Eigen::VectorXd story_parameters(const Structure& structure, const ParameterTable& table,
                                 const GroupDesign& design, const Eigen::VectorXd& of_groups);

}  // namespace framewatch::estimator
