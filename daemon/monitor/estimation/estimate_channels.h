#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"

namespace framewatch::daemon {

/// The LCM channels of the estimates, by WindowEstimate::window: the main window, the other windows
/// and, if it is configured, the long one.
std::vector<std::string> estimate_channels(const Config& config);

/// Behind the name of a channel: its estimates that come after their time (WindowEstimate::late).
inline constexpr const char* kLate = "_LATE";

}  // namespace framewatch::daemon
