#include "daemon/monitor/live/heard_channels.h"

#include <algorithm>

#include "daemon/monitor/estimation/estimation.h"

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

std::string channels_without_source(const Config& config, bool by_name) {
  std::string names;
  for (std::size_t i = 0; i < config.sources.size() && !by_name; ++i)
    if (config.sources[i].sensor_node < 0 && config.sources[i].can.empty())
      names += (names.empty() ? "" : ", ") + config.pipeline.axes[i].name;
  return names;
}

std::string nothing_to_hear(const Config& config, bool by_name) {
  const bool any =
      std::any_of(config.sources.begin(), config.sources.end(),
                  [](const AxisSource& s) { return s.sensor_node >= 0 || !s.can.empty(); });
  if (any || by_name) return {};
  return config.path +
         ": no channel has a source, so no sample can come: give each [[channel]] one, such as "
         "source = { lcm = \"ACCEL\", node = 3, axis = \"x\" }; or say --by-name when the nodes "
         "themselves name their channels (channel_table_t)";
}

std::string acknowledge_channel(const Config& config) {
  return config.lcm.prefix + "ACKNOWLEDGE";
}

}  // namespace framewatch::daemon
