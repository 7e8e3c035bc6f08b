// SPDX-License-Identifier: MIT
#include "daemon/config/channel_addresses.h"

#include <algorithm>

namespace framewatch::daemon {

std::vector<drivers::AxisAddress> addresses(const std::vector<AxisSource>& sources) {
  int highest = 0;
  for (const AxisSource& source : sources) highest = std::max(highest, source.sensor_node);
  std::vector<drivers::AxisAddress> out;
  for (const AxisSource& source : sources) {
    if (source.sensor_node >= 0)
      out.push_back({source.lcm_channel, source.sensor_node, source.axis});
    else
      out.push_back({"ACCEL", ++highest, 0});
  }
  return out;
}

drivers::AccelMessages accel_messages(const Config& config, double rate_hz) {
  return {axis_names(config), addresses(config.sources), rate_hz};
}

}  // namespace framewatch::daemon
