#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"

namespace framewatch::daemon {

/// The LCM channels of samples and of their channel tables.
std::vector<std::string> sample_channels(const Config& config);
/// The channels an estimation listens to: those and the one of the thermometer.
std::vector<std::string> heard_channels(const Config& config);

/// Why nothing can be received: no channel has a source, and nodes do not name them (`by_name`).
/// Empty: something can.
std::string nothing_to_hear(const Config& config, bool by_name);
/// The names of the channels without a source, for a warning; empty when there are none, and when
/// nodes name them.
std::string channels_without_source(const Config& config, bool by_name);

/// Where somebody on LCM may ask `framewatch run` to acknowledge an event.
std::string acknowledge_channel(const Config& config);

}  // namespace framewatch::daemon
