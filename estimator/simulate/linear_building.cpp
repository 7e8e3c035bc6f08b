// SPDX-License-Identifier: MIT
#include "estimator/simulate/linear_building.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"

namespace framewatch::estimator {

LinearBuilding::LinearBuilding(const Structure& structure, const ParameterTable& table,
                               const Eigen::VectorXd& theta, double step_s)
    : LinearBuilding(structure, table, theta, ground_inputs(structure), step_s) {}

LinearBuilding::LinearBuilding(const Structure& structure, const ParameterTable& table,
                               const Eigen::VectorXd& theta, Inputs inputs, double step_s)
    : structure_(structure),
      table_(table),
      step_s_(step_s),
      constraint_(floor_constraint(structure)),
      inputs_(std::move(inputs)) {
  assert(step_s > 0);
  state_ = Eigen::VectorXd::Zero(2 * constraint_.cols() + 2 * inputs_.influence.cols());
  next_ = state_;
  accel_abs_ = Eigen::VectorXd::Zero(structure.degrees_of_freedom());
  set_theta(theta);
}

void LinearBuilding::set_theta(const Eigen::VectorXd& theta) {
  assert(theta.size() == table_.size());
  const Matrices matrices = assemble(structure_, table_, theta);
  const Eigen::Index q = constraint_.cols();
  const Eigen::MatrixXd constraint_mass = constraint_.transpose() * matrices.mass.asDiagonal();
  const Ldlt mass(constraint_mass * constraint_);
  const Eigen::MatrixXd stiffness =
      mass.solve(Eigen::MatrixXd(constraint_.transpose() * matrices.stiffness * constraint_));
  const Eigen::MatrixXd damping =
      mass.solve(Eigen::MatrixXd(constraint_.transpose() * matrices.damping * constraint_));

  const double scale_before = velocity_scale_;
  velocity_scale_ = std::sqrt(stiffness.diagonal().maxCoeff());
  if (!(velocity_scale_ > 0)) velocity_scale_ = 1;
  state_.head(q) *= velocity_scale_ / scale_before;

  // d/dt (state, inputs, their slope) = generator * (...): its exponential over one step holds
  // the transition and both first-order-hold input matrices.
  const Eigen::Index n = inputs_.influence.cols();
  Eigen::MatrixXd generator = Eigen::MatrixXd::Zero(2 * q + 2 * n, 2 * q + 2 * n);
  generator.block(0, q, q, q).diagonal().setConstant(velocity_scale_);
  generator.block(q, 0, q, q) = -stiffness / velocity_scale_;
  generator.block(q, q, q, q) = -damping;
  const Eigen::MatrixXd pushed =
      mass.solve(Eigen::MatrixXd(constraint_.transpose() * inputs_.force));
  generator.block(q, 2 * q, q, n) =
      pushed - mass.solve(Eigen::MatrixXd(constraint_mass * inputs_.influence));
  generator.block(2 * q, 2 * q + n, n, n).setIdentity();
  const Eigen::MatrixXd scaled = generator * step_s_;
  const Eigen::MatrixXd exponential = matrix_exponential(scaled);
  transition_ = exponential.topRows(2 * q);
  transition_.rightCols(n) /= step_s_;

  output_.resize(accel_abs_.size(), 2 * q);
  output_.leftCols(q) = -constraint_ * stiffness / velocity_scale_;
  output_.rightCols(q) = -constraint_ * damping;
  direct_ = inputs_.force.isZero(0) ? RowMatrix(0, n) : RowMatrix(constraint_ * pushed);
  update_accel();
}

void LinearBuilding::set_state(const Eigen::VectorXd& disp_rel, const Eigen::VectorXd& vel_rel) {
  const Eigen::Index q = constraint_.cols();
  const LeastSquares decomposition(constraint_);
  state_.head(q) = velocity_scale_ * decomposition.solve(disp_rel);
  state_.segment(q, q) = decomposition.solve(vel_rel);
  update_accel();
}

void LinearBuilding::drive(const Eigen::Ref<const Eigen::VectorXd>& before,
                           const Eigen::Ref<const Eigen::VectorXd>& after) {
  const Eigen::Index n = inputs_.influence.cols();
  state_.segment(state_.size() - 2 * n, n) = before;
  state_.tail(n) = after - before;
  multiply(transition_, state_.data(), next_.data(), 0, state_.size());
  next_.tail(2 * n) = state_.tail(2 * n);
  state_.swap(next_);
  update_accel();
}

bool LinearBuilding::resume(const std::vector<double>& motion) {
  if (motion.size() != static_cast<std::size_t>(state_.size())) return false;
  std::copy(motion.begin(), motion.end(), state_.begin());
  update_accel();
  return true;
}

void LinearBuilding::update_accel() {
  multiply(output_, state_.data(), accel_abs_.data(), 0, output_.cols());
  if (direct_.rows() == 0) return;
  const Eigen::Index n = direct_.cols();
  accel_abs_ += direct_ * (state_.segment(state_.size() - 2 * n, n) + state_.tail(n));
}

Eigen::VectorXd LinearBuilding::disp_rel() const {
  return constraint_ * state_.head(constraint_.cols()) / velocity_scale_;
}

Eigen::VectorXd LinearBuilding::vel_rel() const {
  return constraint_ * state_.segment(constraint_.cols(), constraint_.cols());
}

}  // namespace framewatch::estimator
