#include "daemon/monitor/estimation/wanted_axes.h"

namespace framewatch::daemon {

std::vector<drivers::WantedAxis> wanted_axes(const Config& config) {
  std::vector<drivers::WantedAxis> wanted;
  for (std::size_t i = 0; i < config.pipeline.axes.size(); ++i) {
    const AxisSource source = i < config.sources.size() ? config.sources[i] : AxisSource{};
    wanted.push_back({config.pipeline.axes[i].name, source.lcm_channel, source.sensor_node,
                      source.axis, source.can.empty()});
  }
  return wanted;
}

drivers::IntakeSettings intake_settings(const Config& config) {
  return {config.pipeline.options.rate_hz, config.lcm.two_senders};
}

}  // namespace framewatch::daemon
