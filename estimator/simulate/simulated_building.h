// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Computes out = a * x for `columns` columns of a, from `first` on, explicitly because Eigen's
/// product is many times slower in a debug build.
inline void multiply(const RowMatrix& a, const double* x, double* out, Eigen::Index first,
                     Eigen::Index columns) {
  const double* row = a.data() + first;
  for (Eigen::Index r = 0; r < a.rows(); ++r, row += a.cols()) {
    double sum = 0;
    for (Eigen::Index c = 0; c < columns; ++c) sum += row[c] * x[c];
    out[r] = sum;
  }
}

/// A building that is shaken in steps of step_s(), starting at rest.
class SimulatedBuilding {
 public:
  virtual ~SimulatedBuilding() = default;
  /// Replaces stiffness and damping; displacements and velocities continue.
  virtual void set_theta(const Eigen::VectorXd& theta) = 0;
  /// Advances one step. Arguments: ground acceleration (x, y) at its start and end, m/s^2, linear
  /// between.
  virtual void advance(const Eigen::Vector2d& ground_before,
                       const Eigen::Vector2d& ground_after) = 0;
  virtual double step_s() const = 0;
  /// Sets the time of the present state, s, for time-dependent effects; 0 by default.
  virtual void set_time(double time_s) = 0;
  /// Return the state relative to the ground, one entry per degree of freedom (Structure::dof), m
  /// and m/s.
  virtual Eigen::VectorXd disp_rel() const = 0;
  virtual Eigen::VectorXd vel_rel() const = 0;
  /// Returns absolute accelerations, m/s^2, positive toward +x or +y.
  virtual const Eigen::VectorXd& accel_abs() const = 0;
  /// Returns the external forces that act now, N, one entry per degree of freedom; empty: no
  /// forces.
  virtual const Eigen::VectorXd& applied_n() const {
    static const Eigen::VectorXd none;
    return none;
  }

  /// Returns everything that later motion depends on, except the time.
  virtual std::vector<double> motion() const = 0;
  /// Continues from motion() of the same building. Returns false and changes nothing when it has
  /// another size.
  [[nodiscard]] virtual bool resume(const std::vector<double>& motion) = 0;
};

/// The external inputs that move a building, one column for each.
struct Inputs {
  /// Degrees of freedom x inputs: acceleration, m/s^2 per unit of input, of floors that follow the
  /// base as one rigid body. The motion is relative to that.
  Eigen::MatrixXd influence;
  Eigen::MatrixXd force;  ///< degrees of freedom x inputs: N per unit of input
};

/// Returns the inputs of the ground's acceleration along x and y, m/s^2.
inline Inputs ground_inputs(const Structure& structure) {
  const Eigen::MatrixXd influence = ground_influence(structure);
  return {influence, Eigen::MatrixXd::Zero(influence.rows(), influence.cols())};
}

/// A building that any inputs shake, linear within a step.
class DrivenBuilding : public SimulatedBuilding {
 public:
  /// Advances one step; inputs at its start and end.
  virtual void drive(const Eigen::Ref<const Eigen::VectorXd>& before,
                     const Eigen::Ref<const Eigen::VectorXd>& after) = 0;
  /// Precondition: the building has ground_inputs().
  void advance(const Eigen::Vector2d& ground_before, const Eigen::Vector2d& ground_after) final {
    drive(ground_before, ground_after);
  }
};

}  // namespace framewatch::estimator
