#pragma once

#include <vector>

#include <Eigen/Core>

namespace framewatch::estimator {

/// A building that is shaken in steps of step_s(), from rest.
class SimulatedBuilding {
 public:
  virtual ~SimulatedBuilding() = default;
  /// New stiffness and damping from now on; displacements and velocities go on from where they are.
  virtual void set_theta(const Eigen::VectorXd& theta) = 0;
  /// One step; ground acceleration (x, y) at its start and end, m/s^2, linear between.
  virtual void advance(const Eigen::Vector2d& ground_before,
                       const Eigen::Vector2d& ground_after) = 0;
  virtual double step_s() const = 0;
  /// Time of the present state, s, for what depends on it; 0 unless it is set.
  virtual void set_time(double time_s) = 0;
  /// Relative to the ground, one entry per degree of freedom (Structure::dof), m and m/s.
  virtual Eigen::VectorXd disp_rel() const = 0;
  virtual Eigen::VectorXd vel_rel() const = 0;
  /// m/s^2, positive toward +x or +y.
  virtual const Eigen::VectorXd& accel_abs() const = 0;
  /// Forces from outside that act now, N, one entry per degree of freedom; empty: there are none.
  virtual const Eigen::VectorXd& applied_n() const {
    static const Eigen::VectorXd none;
    return none;
  }

  /// Everything that later motion depends on, but for the time.
  virtual std::vector<double> motion() const = 0;
  /// Continues from what motion() gave of the same building. False, and nothing changes, when it
  /// has another size.
  [[nodiscard]] virtual bool resume(const std::vector<double>& motion) = 0;
};

}  // namespace framewatch::estimator
