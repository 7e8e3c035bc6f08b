// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/config/sections/settings.h"
#include "drivers/lcm/accel_codec.h"

namespace framewatch::daemon {

/// Returns the names of all channels in the order of the configuration.
inline std::vector<std::string> axis_names(const Config& config) {
  std::vector<std::string> out;
  for (const estimator::SensorAxis& axis : config.pipeline.axes) out.push_back(axis.name);
  return out;
}

/// Returns the LCM channel, node and axis of each source, in the order of `sources`. A channel
/// without a source gets a node above the highest configured one, on LCM channel ACCEL.
std::vector<drivers::AxisAddress> addresses(const std::vector<AxisSource>& sources);

/// Returns a writer of accel_t messages for the channels of `config`, sampled at `rate_hz`.
drivers::AccelMessages accel_messages(const Config& config, double rate_hz);

}  // namespace framewatch::daemon
