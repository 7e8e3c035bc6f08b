// SPDX-License-Identifier: MIT
#include "tests/support/forced_building.h"

#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"

namespace framewatch::test {

using namespace estimator;

ForcedBuilding::ForcedBuilding(const Structure& s, const Eigen::VectorXd& theta,
                               Eigen::VectorXd lever, std::function<double(double)> force,
                               double step_s)
    : lever_(std::move(lever)),
      force_(std::move(force)),
      step_s_(step_s),
      accel_(Eigen::VectorXd::Zero(s.degrees_of_freedom())),
      applied_(accel_) {
  const Matrices m = assemble(s, ParameterTable(s), theta);
  const Eigen::MatrixXd t = floor_constraint(s);
  const Eigen::MatrixXd inverse_mass = inverse(t.transpose() * m.mass.asDiagonal() * t);
  const Eigen::Index q = t.cols();
  Eigen::MatrixXd input(q, 3);  // force, ground
  input << inverse_mass * t.transpose() * lever_,
      -inverse_mass * t.transpose() * m.mass.asDiagonal() * ground_influence(s);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * q + 6, 2 * q + 6);
  a.block(0, q, q, q).setIdentity();
  a.block(q, 0, q, q) = -inverse_mass * t.transpose() * m.stiffness * t;
  a.block(q, q, q, q) = -inverse_mass * t.transpose() * m.damping * t;
  a.block(q, 2 * q, q, 3) = input;
  a.block(2 * q, 2 * q + 3, 3, 3).setIdentity();
  const Eigen::MatrixXd e = matrix_exponential(Eigen::MatrixXd(a * step_s));
  transition_ = e.topRows(2 * q);
  output_ = t * a.block(q, 0, q, 2 * q);
  direct_ = t * input.leftCols(1);  // the ground's share is that of its own acceleration
  state_ = Eigen::VectorXd::Zero(2 * q);
}

void ForcedBuilding::advance(const Eigen::Vector2d& before, const Eigen::Vector2d& after) {
  const double force = force_(time_s_);
  time_s_ += step_s_;
  const double next = force_(time_s_);
  Eigen::VectorXd all(state_.size() + 6);
  all << state_, force, before, (next - force) / step_s_, (after - before) / step_s_;
  state_ = transition_ * all;
  accel_ = output_ * state_ + direct_ * next;
  applied_ = lever_ * next;
}

}  // namespace framewatch::test
