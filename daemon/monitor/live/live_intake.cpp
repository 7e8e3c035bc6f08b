// SPDX-License-Identifier: MIT
#include "daemon/monitor/live/live_intake.h"

#include <poll.h>

#include <algorithm>
#include <utility>

#include "daemon/base/clocks.h"
#include "daemon/monitor/estimation/estimation.h"

namespace framewatch::daemon {

LiveIntake::LiveIntake(drivers::LcmProvider& lcm, const std::vector<std::string>& channels,
                       int queue_capacity, drivers::LcmSource::Handler on_message,
                       const drivers::CanMap& can, bool every_frame,
                       drivers::CanSource::Handler on_frame)
    : has_buses_(!can.empty()),
      lcm_(lcm, channels, queue_capacity, std::move(on_message)),
      can_(can, every_frame, std::move(on_frame)) {}

bool LiveIntake::poll(int timeout_ms) {
  if (!has_buses_) return lcm_.handle(timeout_ms);
  std::vector<pollfd> waiting{{lcm_.descriptor(), POLLIN, 0}};
  can_.descriptors(waiting);
  ::poll(waiting.data(), waiting.size(), timeout_ms);
  can_.handle(steady_clock_us());
  return lcm_.handle(0);
}

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
  for (const WeatherSettings& w : config.weather)
    for (const std::string& channel : {w.lcm_channel, w.thermometer})
      if (!channel.empty() && std::ranges::find(channels, channel) == channels.end())
        channels.push_back(channel);
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
         "source = { lcm = \"ACCEL\", node = 3, axis = \"x\" }; or use --by-name when the nodes "
         "themselves name their channels (channel_table_t)";
}

std::string acknowledge_channel(const Config& config) {
  return config.lcm.prefix + "ACKNOWLEDGE";
}

}  // namespace framewatch::daemon
