#include "daemon/live/heard_channels.h"

#include "daemon/estimation/estimation.h"

namespace framewatch::daemon {

std::vector<std::string> sample_channels(const Config& config) {
  std::vector<std::string> channels = drivers::AxisBinding(wanted_axes(config)).streams();
  for (std::size_t i = 0, streams = channels.size(); i < streams; ++i)
    channels.push_back(channels[i] + "_CHANNELS");
  return channels;
}

std::vector<std::string> heard_channels(const Config& config) {
  std::vector<std::string> channels = sample_channels(config);
  if (config.watch && !config.watch->temperature_channel.empty())
    channels.push_back(config.watch->temperature_channel);
  return channels;
}

std::string acknowledge_channel(const Config& config) {
  return config.lcm.prefix + "ACKNOWLEDGE";
}

}  // namespace framewatch::daemon
