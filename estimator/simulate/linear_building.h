// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "estimator/simulate/simulated_building.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Advances M y'' + C y' + K y = -M r a_g + f in time (first-order-hold state space by the matrix
/// exponential), exactly while the inputs are linear within a step. Floors are rigid or flexible,
/// as in the structure. Starts at rest.
class LinearBuilding : public DrivenBuilding {
 public:
  /// theta in table order; step_s > 0.
  LinearBuilding(const Structure& structure, const ParameterTable& table,
                 const Eigen::VectorXd& theta, double step_s);
  LinearBuilding(const Structure& structure, const ParameterTable& table,
                 const Eigen::VectorXd& theta, Inputs inputs, double step_s);

  void set_theta(const Eigen::VectorXd& theta) override;
  /// Sets the state relative to the ground, one entry per degree of freedom, m and m/s.
  void set_state(const Eigen::VectorXd& disp_rel, const Eigen::VectorXd& vel_rel);

  void drive(const Eigen::Ref<const Eigen::VectorXd>& before,
             const Eigen::Ref<const Eigen::VectorXd>& after) override;
  double step_s() const override { return step_s_; }
  void set_time(double) override {}
  Eigen::VectorXd disp_rel() const override;
  Eigen::VectorXd vel_rel() const override;
  const Eigen::VectorXd& accel_abs() const override { return accel_abs_; }
  std::vector<double> motion() const override { return {state_.begin(), state_.end()}; }
  [[nodiscard]] bool resume(const std::vector<double>& motion) override;

 private:
  void update_accel();

  Structure structure_;
  ParameterTable table_;
  double step_s_;
  Eigen::MatrixXd constraint_;  ///< degrees of freedom x independent coordinates
  Inputs inputs_;
  double velocity_scale_ = 1;  ///< 1/s; displacements are stored times this, which balances A
  RowMatrix transition_;       ///< state x (state, inputs before, their change)
  RowMatrix output_;           ///< degrees of freedom x state
  RowMatrix direct_;           ///< degrees of freedom x inputs: immediate effect of forces
  Eigen::VectorXd state_;      ///< scaled coordinates, their velocities, inputs, their change
  Eigen::VectorXd next_;
  Eigen::VectorXd accel_abs_;
};

}  // namespace framewatch::estimator
