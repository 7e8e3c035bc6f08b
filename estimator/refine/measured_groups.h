#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/identify/groups/reduced_building.h"
#include "estimator/refine/spectrum.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// The equations of motion of the measured floors of a building with sensors on some: floors
/// between them follow from their motion. docs/equations.md, groups of stories.
struct MeasuredGroups {
  ReducedBuilding building;
  Eigen::VectorXd designed;  ///< the parameters of which the building's parts are
  /// By parameter: F with F F' its part of the building's stiffness or damping, of the rows that
  /// are not zero, which `touched` lists.
  std::vector<Eigen::MatrixXd> factors;
  std::vector<std::vector<Eigen::Index>> touched;
  /// Forces on all coordinates by the momentum of each mode of the inner ones with the measured
  /// ones held, and the modes' frequencies, Hz.
  Eigen::MatrixXd momenta;
  Eigen::VectorXd inner_hz;
  Eigen::VectorXd variance;  ///< of one sample's white noise, per axis, (m/s^2)^2
  Eigen::VectorXd delay;     ///< s, per axis
  bool noise_known = true;   ///< false: kDefaultNoiseDensity is used for axes without one

  Eigen::Index equations() const { return building.rows(); }
  Eigen::Index parameters() const { return designed.size(); }
  Eigen::Index axes() const { return building.from_axes.cols(); }
};

/// config: of groups. Without equations where the base is not measured in a direction that is
/// measured above it.
MeasuredGroups measured_groups(const PipelineConfig& config);

/// From 0.4 times the lowest natural frequency of the building of theta to twice the highest of a
/// measured floor between neighbours at rest, at most 0.4 of the sampling rate.
Band groups_band(const MeasuredGroups& groups, const Eigen::VectorXd& theta, double rate_hz);

}  // namespace framewatch::estimator
