#pragma once

#include <lcm/lcm-cpp.hpp>

#include <memory>
#include <string>
#include <vector>

#include "daemon/tools/simulation/simulation.h"

namespace framewatch::daemon {

/// Sends the frames of the CAN nodes of the scenario's configuration on CAN interfaces, at `speed`
/// times real time, with SYNC for nodes that sample at it; the bit rate of a bus spaces its frames.
/// `interface`: instead of the configured one, when there is one bus. Frames are
/// lost while an interface is away. Null, and the reason, when one cannot be opened.
/// `scenario` must outlive it.
std::unique_ptr<SimulationOutput> can_output(const Scenario& scenario, const std::string& interface,
                                             double speed, std::string& error);

/// Stores or sends the instants of a virtual test, one after the other.
class SimulationOutput {
 public:
  virtual ~SimulationOutput() = default;
  /// False when it cannot be stored or sent; error() says why, here and below.
  [[nodiscard]] virtual bool put(double time_s, const std::vector<double>& raw) = 0;
  /// A file gets its final name only here.
  [[nodiscard]] virtual bool close() = 0;
  virtual std::string error() const = 0;
};

/// By the name's end: .csv, .csv.gz or .lcmlog. Null, and the reason, when it cannot be made.
std::unique_ptr<SimulationOutput> file_output(const Scenario& scenario, const std::string& path,
                                              std::string& error);

/// LCM, at `speed` times real time from the first instant on; sensor time is the host's clock then
/// plus the test's time. `lcm` must outlive it.
std::unique_ptr<SimulationOutput> live_output(const Scenario& scenario, lcm::LCM& lcm,
                                              double speed);

}  // namespace framewatch::daemon
