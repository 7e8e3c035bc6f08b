#include "daemon/monitor/estimation/estimate_channels.h"

#include <fmt/core.h>

namespace framewatch::daemon {

std::vector<std::string> estimate_channels(const Config& config) {
  const std::string main = config.lcm.prefix + "ESTIMATE";
  std::vector<std::string> channels{main};
  for (const double window_s : config.pipeline.options.other_windows_s)
    channels.push_back(fmt::format("{}_{:g}S", main, window_s));
  if (const double window_s = config.pipeline.options.long_window_s; window_s > 0)
    channels.push_back(fmt::format("{}_{:g}S", main, window_s));
  return channels;
}

}  // namespace framewatch::daemon
