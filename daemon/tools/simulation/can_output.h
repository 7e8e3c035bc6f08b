#pragma once

#include <memory>
#include <string>

#include "daemon/tools/simulation/simulation_output.h"

namespace framewatch::daemon {

/// Sends the frames of the CAN nodes of the scenario's configuration on CAN interfaces, at `speed`
/// times real time, with SYNC for nodes that sample at it; the bit rate of a bus spaces its frames.
/// `interface`: instead of the configured one, when there is one bus. Frames are
/// lost while an interface is away. Null, and the reason, when one cannot be opened.
/// `scenario` must outlive it.
std::unique_ptr<SimulationOutput> can_output(const Scenario& scenario, const std::string& interface,
                                             double speed, std::string& error);

}  // namespace framewatch::daemon
