#pragma once

#include <vector>

#include <Eigen/Core>

namespace framewatch::estimator {

/// A spring and a dashpot along b: force k b'y + c b'y' on the degrees of freedom b.
struct LinearElement {
  Eigen::VectorXd b;
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N*s/m
};

/// The linear part of a building with its effects. Degrees of freedom are the structure's, then
/// one for each hidden mass, all relative to the ground.
struct LinearModel {
  Eigen::VectorXd mass;               ///< kg
  Eigen::MatrixXd influence;          ///< x inputs: acceleration with the base, per unit of input
  Eigen::MatrixXd constraint;         ///< x independent coordinates
  std::vector<LinearElement> linear;  ///< first those of theta, in its order, then the effects'

  Eigen::MatrixXd stiffness() const;  ///< of the degrees of freedom
  Eigen::MatrixXd damping() const;
};

}  // namespace framewatch::estimator
