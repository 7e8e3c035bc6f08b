// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimator/setup/pipeline_config.h"

namespace framewatch::daemon {

/// A stretch that is refined, without the channels that have no sample in it.
struct RefinedSegment {
  estimator::PipelineConfig config;
  Eigen::MatrixXd accel;            ///< instants x config.axes, m/s^2
  std::vector<std::string> silent;  ///< the channels left out
};

/// Returns the stretch for refine_max_likelihood(). axes: calibrated, of the columns of accel.
/// Silent channels stay if the building cannot be identified without them.
RefinedSegment without_silent_channels(const estimator::PipelineConfig& config,
                                       const std::vector<estimator::SensorAxis>& axes,
                                       const Eigen::MatrixXd& accel);

/// Returns the design of the identified parameters, SI.
Eigen::VectorXd identified_design(const estimator::PipelineConfig& config);

}  // namespace framewatch::daemon
