#pragma once

#include <string>

#include "drivers/can/can_intake.h"

namespace framewatch::daemon {

/// Counts of what the CAN nodes sent, as text of several lines; empty without CAN.
std::string can_text(const drivers::CanIntake& can);
/// The same as JSON members can_nodes and can_buses, with a comma after each; empty without CAN.
std::string can_json(const drivers::CanIntake& can);

}  // namespace framewatch::daemon
