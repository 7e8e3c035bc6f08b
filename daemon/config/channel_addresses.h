#pragma once

#include <vector>

#include "daemon/config/sections/settings.h"
#include "drivers/lcm/accel_codec.h"

namespace framewatch::daemon {

/// Returns the LCM channel, node and axis of each source, in the order of `sources`. A channel
/// without a source gets a node above the highest configured one, on LCM channel ACCEL.
std::vector<drivers::AxisAddress> addresses(const std::vector<AxisSource>& sources);

/// Returns a writer of accel_t messages for the channels of `config`, sampled at `rate_hz`.
drivers::AccelMessages accel_messages(const Config& config, double rate_hz);

}  // namespace framewatch::daemon
