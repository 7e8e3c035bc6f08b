#pragma once

#include <Eigen/Core>

namespace framewatch::estimator {

/// Everything about a building's motion that the paper's method uses: instants x degrees of freedom
/// (Structure::dof), SI.
struct MotionHistory {
  Eigen::MatrixXd accel_abs;
  Eigen::MatrixXd vel_rel;  ///< to the ground, like disp_rel
  Eigen::MatrixXd disp_rel;
};

}  // namespace framewatch::estimator
