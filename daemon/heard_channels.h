#pragma once

#include <string>
#include <vector>

#include "daemon/config.h"

namespace framewatch::daemon {

/// The LCM channels that samples and their tables come on.
std::vector<std::string> sample_channels(const Config& config);
/// Those an estimation listens to: the thermometer's too.
std::vector<std::string> heard_channels(const Config& config);

}  // namespace framewatch::daemon
