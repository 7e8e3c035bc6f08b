#pragma once

#include <string>
#include <vector>

#include "daemon/config.h"

namespace framewatch::daemon {

/// Of every channel, in the order of the configuration.
inline std::vector<std::string> channel_names(const Config& config) {
  std::vector<std::string> out;
  for (const SensorAxis& axis : config.pipeline.axes) out.push_back(axis.name);
  return out;
}

}  // namespace framewatch::daemon
