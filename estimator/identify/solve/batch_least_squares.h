// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The motion of a building as the paper's method uses it: instants x degrees of freedom
/// (Structure::dof), SI.
struct MotionHistory {
  Eigen::MatrixXd accel_abs;
  Eigen::MatrixXd vel_rel;  ///< relative to the ground, as disp_rel
  Eigen::MatrixXd disp_rel;
};

/// Identifies as in the paper's numerical examples, where accelerations, velocities and
/// displacements are all given: plain least squares over all instants, P1 (18)-(21). Floors must be
/// flexible. Returns theta, SI, or an empty vector if the normal equations are singular. Source:
/// docs/equations.md (7) and (17) with unfiltered regressors.
Eigen::VectorXd batch_least_squares(const Structure& structure, const ParameterTable& table,
                                    const MotionHistory& motion);

}  // namespace framewatch::estimator
