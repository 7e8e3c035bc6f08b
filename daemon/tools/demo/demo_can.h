#pragma once

#include <string>

#include "daemon/config/config.h"

namespace framewatch::daemon {

/// Gives every accelerometer of the demo a CANopen node of its own on the bus of `interface`, at
/// 500 kbit/s: it samples at the SYNC and sends 24 bits of 1e-5 m/s^2 and a counter.
void put_on_can(Config& config, const std::string& interface);

}  // namespace framewatch::daemon
