#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimator/setup/options.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Everything the estimating process needs to know, validated by problems().
struct PipelineConfig {
  Structure structure;
  std::vector<SensorAxis> axes;
  EstimatorOptions options;
  /// Design parameters, theta order, SI; empty when the drawings say nothing.
  Eigen::VectorXd design;
};

std::vector<std::string> problems(const PipelineConfig& config);

}  // namespace framewatch::estimator
