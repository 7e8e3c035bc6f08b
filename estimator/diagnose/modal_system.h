#pragma once

#include <Eigen/Core>

namespace framewatch {

/// M y'' + C y' + K y = P u, marched in its complex modes with u linear within a step: exact for
/// the linear part whatever the step. Sources: docs/equations.md (29), Foss (1958).
class ModalSystem {
 public:
  /// P: coordinates x inputs; mass: coordinates x coordinates, positive definite.
  ModalSystem(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& damping,
              const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& inputs, double step_s);

  /// Back to rest.
  void reset();
  /// What the state will be after a step with the inputs `now` at its end, `watched` inputs zero
  /// there. Displacement and velocity: see observe().
  void predict(const Eigen::VectorXd& now);
  /// Adds the watched inputs' values at the end of the step and makes it the state.
  void correct(const Eigen::VectorXd& now);

  /// Rows that observe displacement (r y): state -> value, and what an input at the end of a step
  /// adds to it at once.
  struct Observer {
    Eigen::RowVectorXcd displacement, velocity;           ///< over the modes
    Eigen::RowVectorXd displacement_gain, velocity_gain;  ///< over the inputs
  };
  Observer observe(const Eigen::VectorXd& row) const;
  double displacement(const Observer& o) const { return (o.displacement * state_)(0).real(); }
  double velocity(const Observer& o) const { return (o.velocity * state_)(0).real(); }
  bool good() const { return good_; }

 private:
  bool good_ = true;
  Eigen::Index coordinates_;
  Eigen::MatrixXcd shapes_;  ///< 2 coordinates x modes, real part taken after weighting
  Eigen::VectorXcd turn_;
  Eigen::MatrixXcd first_, last_;  ///< modes x inputs: weight of u at the step's start and end
  Eigen::VectorXcd state_;
  Eigen::VectorXcd before_;  ///< first_ * u at the start of the step
};

}  // namespace framewatch
