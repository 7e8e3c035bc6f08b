#pragma once

#include <vector>

#include "daemon/config/config.h"
#include "drivers/lcm/accel_intake.h"

namespace framewatch::daemon {

/// The configured axes as the drivers know them.
std::vector<drivers::WantedAxis> wanted_axes(const Config& config);
/// How their messages are taken in.
drivers::IntakeSettings intake_settings(const Config& config);

}  // namespace framewatch::daemon
