#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"

namespace framewatch::daemon {

/// The LCM channels of samples and of their channel tables.
std::vector<std::string> sample_channels(const Config& config);
/// The channels an estimation listens to: those and the one of the thermometer.
std::vector<std::string> heard_channels(const Config& config);

/// Where somebody on LCM may ask `framewatch run` to acknowledge an event.
std::string acknowledge_channel(const Config& config);

}  // namespace framewatch::daemon
