#pragma once

#include <Eigen/Core>

#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Everything about a building's motion that the paper's method uses: instants x degrees of freedom
/// (Structure::dof), SI.
struct MotionHistory {
  Eigen::MatrixXd accel_abs;
  Eigen::MatrixXd vel_rel;  ///< to the ground, like disp_rel
  Eigen::MatrixXd disp_rel;
};

/// The paper's identification as its numerical examples have it: accelerations, velocities and
/// displacements are all given, plain least squares over all instants, P1 (18)-(21). Floors are
/// flexible. Theta order, SI; empty when the normal equations are singular.
/// Source: docs/equations.md (7) and (17) with the regressors taken as they are.
Eigen::VectorXd batch_least_squares(const Structure& structure, const ParameterTable& table,
                                    const MotionHistory& motion);

}  // namespace framewatch::estimator
