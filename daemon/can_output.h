#pragma once

#include <memory>
#include <string>

#include "daemon/simulation_output.h"

namespace framewatch::daemon {

/// The nodes of the scenario's configuration on real CAN interfaces, at `speed` times real time,
/// with the SYNC of latched ones; frames of a bus follow each other as its bit rate has it.
/// `interface`: instead of the configured one, when there is one bus. An interface that goes away
/// later takes the frames of that time with it. Null, and the reason, when one cannot be opened.
/// `scenario` must outlive it.
std::unique_ptr<SimulationOutput> can_output(const Scenario& scenario, const std::string& interface,
                                             double speed, std::string& error);

}  // namespace framewatch::daemon
