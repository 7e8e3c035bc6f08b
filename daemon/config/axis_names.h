#pragma once

#include <string>
#include <vector>

#include "daemon/config/sections/settings.h"

namespace framewatch::daemon {

/// Names of all channels, in the order of the configuration.
inline std::vector<std::string> axis_names(const Config& config) {
  std::vector<std::string> out;
  for (const estimator::SensorAxis& axis : config.pipeline.axes) out.push_back(axis.name);
  return out;
}

}  // namespace framewatch::daemon
