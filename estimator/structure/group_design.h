#pragma once

#include <Eigen/Core>

#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// What the building is for parameters as designed.
struct GroupDesign {
  Eigen::VectorXd theta;  ///< every story's, in the order of ParameterTable(structure), SI
  BendingStiffness bending_nmprad{};
};

/// The parameters of groups, table order, SI: stories in series, frames of a group side by side.
Eigen::VectorXd group_parameters(const Structure& structure, const ParameterTable& table,
                                 const GroupDesign& design);

/// Parameters of every story, in the order of ParameterTable(structure), from those of groups: each
/// story keeps its share of the design.
Eigen::VectorXd story_parameters(const Structure& structure, const ParameterTable& table,
                                 const GroupDesign& design, const Eigen::VectorXd& of_groups);

}  // namespace framewatch::estimator
