// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace framewatch::estimator {

/// Integrates M y'' + C y' + K y = P u in its complex modes, with u linear within a step. The
/// linear part is exact at any step length. Sources: docs/equations.md (29), Foss (1958).
class ModalSystem {
 public:
  /// P: coordinates x inputs; mass: coordinates x coordinates, positive definite.
  ModalSystem(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& damping,
              const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& inputs, double step_s);

  /// Adds an input and returns its index. per_mass: acceleration of the coordinates at rest per
  /// unit of the input.
  Eigen::Index add_input(const Eigen::VectorXd& per_mass);

  /// Returns to rest.
  void reset();
  /// Starts from displacements and velocities of the coordinates, without inputs.
  void start(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity);
  /// Advances the state by a step with the inputs `now` at its end. Inputs that depend on the
  /// motion are zero in `now`.
  void predict(const Eigen::VectorXd& now);
  /// Adds the inputs that depend on the motion at the end of the same step.
  void correct(const Eigen::VectorXd& now);

  /// Displacement and velocity r y of the coordinates as functions of the state, and their gains
  /// from inputs at the end of a step.
  struct Observer {
    Eigen::RowVectorXcd displacement, velocity;           ///< over the modes
    Eigen::RowVectorXd displacement_gain, velocity_gain;  ///< over the inputs
  };
  Observer observe(const Eigen::VectorXd& row) const;
  double displacement(const Observer& o) const { return (o.displacement * state_)(0).real(); }
  double velocity(const Observer& o) const { return (o.velocity * state_)(0).real(); }
  /// Returns false if the modes cannot be computed or one of them grows.
  bool good() const { return good_; }

 private:
  bool good_ = true;
  Eigen::Index coordinates_;
  Eigen::MatrixXcd entry_;   ///< modes x 2 coordinates: from displacements and velocities
  Eigen::MatrixXcd shapes_;  ///< 2 coordinates x modes, real part taken after weighting
  Eigen::VectorXcd turn_;    ///< factor of each mode over a step
  Eigen::VectorXcd of_first_, of_last_;  ///< weights of a mode's force at the step's start and end
  Eigen::MatrixXcd first_, last_;  ///< modes x inputs: weight of u at the step's start and end
  Eigen::VectorXcd state_;
  Eigen::VectorXcd before_;  ///< first_ * u at the start of the step
};

}  // namespace framewatch::estimator
