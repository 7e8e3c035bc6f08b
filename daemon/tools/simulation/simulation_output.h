// SPDX-License-Identifier: MIT
#pragma once

#include <lcm/lcm-cpp.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/tools/simulation/simulation.h"
#include "drivers/records/record.h"

namespace framewatch::daemon {

/// Stores or sends the instants of a virtual test.
class SimulationOutput {
 public:
  virtual ~SimulationOutput() = default;
  /// Stores or sends one instant. Returns false on failure, as finishing does; error() has the
  /// reason.
  [[nodiscard]] virtual bool put(double time_s, const std::vector<double>& raw) = 0;
  /// Finishes the output. A file gets its final name here.
  [[nodiscard]] virtual bool close() = 0;
  virtual std::string error() const = 0;
};

/// Creates the file type of the name's ending: .csv, .csv.gz or .lcmlog. Returns null and sets the
/// error on failure.
std::unique_ptr<SimulationOutput> file_output(const Scenario& scenario, const std::string& path,
                                              std::string& error);

/// Returns an output to LCM at `speed` times real time. Sensor time is the host's clock at the
/// first instant plus the test's time. `lcm` must outlive the output.
std::unique_ptr<SimulationOutput> live_output(const Scenario& scenario, lcm::LCM& lcm,
                                              double speed);

/// Returns an output that sends the frames of the configured CAN nodes at `speed` times real time,
/// with SYNC for nodes that need it. The bus's bit rate spaces its frames. `interface` replaces the
/// configured one if there is one bus. Frames are lost while an interface is down. Returns null and
/// sets the error if one cannot be opened. `scenario` must outlive the output.
std::unique_ptr<SimulationOutput> can_output(const Scenario& scenario, const std::string& interface,
                                             double speed, std::string& error);

/// Returns an output that sets `record` to the instants, in axis order. `record` must outlive it.
std::unique_ptr<SimulationOutput> record_output(const Scenario& scenario, drivers::Record& record);

/// Simulates a scenario, passes every instant to every output and closes them. `name` is the
/// scenario's in messages. step: called with the number of instants done; may throw to end the
/// simulation. Returns an empty string, or why it ended early.
std::string run_simulation(const Scenario& scenario, const std::string& name,
                           const std::vector<std::unique_ptr<SimulationOutput>>& outputs,
                           const std::function<void(std::int64_t done)>& step);

}  // namespace framewatch::daemon
