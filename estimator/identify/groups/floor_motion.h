// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/groups/group_equations.h"
#include "estimator/identify/groups/reduced_building.h"
#include "estimator/motion/sample.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// The motion of every frame on every floor of a building with sensors on some floors. Inner floors
/// are simulated from the measured ones above and below them, as in the estimation (virtual
/// sensors). Between the ends and inner floors, the modes leave out damping that is not
/// proportional to stiffness.
class FloorMotion {
 public:
  explicit FloorMotion(const PipelineConfig& config);

  /// Starts anew with identified parameters. theta: order of config.parameters(), SI. present:
  /// flags of the axes in use. Takes unbounded time and allocates.
  void tune(const Eigen::VectorXd& theta, const std::vector<std::uint8_t>& present);

  /// Takes one calibrated instant. Returns the absolute accelerations of the frames at the base,
  /// then at every floor (ReducedBuilding::frames), m/s^2; NaN while an axis in use has no value.
  const Eigen::VectorXd& push(const SampleSet& set);

  /// Returns the number of instants until the start is forgotten.
  int settle_rows() const { return settle_rows_; }
  const Eigen::VectorXd& theta() const { return theta_; }
  const std::vector<std::uint8_t>& present() const { return present_; }

  void archive(auto& a) {
    for (Eigen::Index i = 0; i < theta_.size(); ++i)
      a.within(theta_[i], std::numeric_limits<double>::min(), a.kMax);
    a.each_within(present_, 0, 1);
    if (a.kReading) form();
    for (Inner& inner : inner_) a.finite(inner.state, inner.input_before);
    a(expected_index_);
  }

 private:
  void form();
  void restart();

  PipelineConfig config_;
  ParameterTable table_;
  GroupDesign design_;
  Eigen::VectorXd designed_, theta_;
  ReducedBuilding building_;
  GroupEquations equations_;
  struct Inner {
    Eigen::VectorXd state, input_before, next;
  };
  std::vector<Inner> inner_;
  std::vector<std::uint8_t> present_;
  std::int64_t expected_index_ = -1;
  int settle_rows_ = 0;
  Eigen::VectorXd measured_, frames_;
};

}  // namespace framewatch::estimator
