// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "estimator/simulate/simulated_building.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::test {

/// A linear building on a base at rest or in motion, driven by a force at one place. Uses the
/// matrix exponential (not the estimator's scheme), which is exact if force and ground are linear
/// within a step.
class ForcedBuilding : public estimator::SimulatedBuilding {
 public:
  /// lever: share of the force on every degree of freedom. force: N at a time in s.
  ForcedBuilding(const estimator::Structure& structure, const Eigen::VectorXd& theta,
                 Eigen::VectorXd lever, std::function<double(double)> force, double step_s);

  void set_theta(const Eigen::VectorXd&) override {}
  void advance(const Eigen::Vector2d& before, const Eigen::Vector2d& after) override;
  double step_s() const override { return step_s_; }
  void set_time(double time_s) override { time_s_ = time_s; }
  Eigen::VectorXd disp_rel() const override { return {}; }
  Eigen::VectorXd vel_rel() const override { return {}; }
  const Eigen::VectorXd& accel_abs() const override { return accel_; }
  const Eigen::VectorXd& applied_n() const override { return applied_; }
  std::vector<double> motion() const override { return {}; }
  bool resume(const std::vector<double>&) override { return false; }

 private:
  Eigen::VectorXd lever_;
  std::function<double(double)> force_;
  double step_s_, time_s_ = 0;
  Eigen::MatrixXd transition_, output_, direct_;
  Eigen::VectorXd state_, accel_, applied_;
};

}  // namespace framewatch::test
