#pragma once

#include <Eigen/Core>

#include "estimator/simulate/simulated_building.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// What moves a building from outside, a column for each.
struct Inputs {
  /// Degrees of freedom x inputs: acceleration, m/s^2 per unit of input, of floors that follow the
  /// base as one rigid body. The motion is relative to that.
  Eigen::MatrixXd influence;
  Eigen::MatrixXd force;  ///< degrees of freedom x inputs: N per unit of input
};

/// The ground's acceleration along x and y, m/s^2.
Inputs ground_inputs(const Structure& structure);

/// A building that any inputs shake. Theirs are linear within a step.
class DrivenBuilding : public SimulatedBuilding {
 public:
  /// One step; inputs at its start and end.
  virtual void drive(const Eigen::Ref<const Eigen::VectorXd>& before,
                     const Eigen::Ref<const Eigen::VectorXd>& after) = 0;
  /// Of a building with ground_inputs().
  void advance(const Eigen::Vector2d& ground_before, const Eigen::Vector2d& ground_after) final {
    drive(ground_before, ground_after);
  }
};

}  // namespace framewatch::estimator
