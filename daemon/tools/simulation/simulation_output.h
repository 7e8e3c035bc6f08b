#pragma once

#include <memory>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "daemon/tools/simulation/simulation.h"

namespace framewatch::daemon {

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
