#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace framewatch::daemon {

/// The state of a service according to systemd.
struct UnitState {
  std::string active, sub, result;  ///< "active", "running", "success"
  std::int64_t restarts = 0;        ///< by systemd, since the service was started by hand
};

/// Empty when systemd does not run this machine, or has no such unit.
std::optional<UnitState> unit_state(const std::string& unit);

/// "active (running), restarted 3 times by systemd since it was last started by hand".
std::string unit_text(const UnitState& state);

/// What is wrong with the service; empty when nothing is.
std::string unit_oddity(const UnitState& state);

}  // namespace framewatch::daemon
