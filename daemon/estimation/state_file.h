#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/estimation/estimation.h"

namespace framewatch::daemon {

/// The state of an estimation as bytes, with a head: format, program, configuration and the number
/// of events that an output has so far (docs/formats.md).
std::vector<std::uint8_t> state_bytes(const Config& config, Estimation& estimation,
                                      std::int64_t events_before);

/// Writes the bytes and a digest to PATH.partial and renames it when they are on the disk. Empty on
/// success, else the problem.
std::string write_state(const std::string& path, std::vector<std::uint8_t> bytes);

struct LoadedState {
  std::string problem;  ///< why it is refused; empty when it was loaded
  std::int64_t events_before = 0;
};
/// Loads a state file into an estimation of the same configuration. A problem found in the file
/// itself leaves the estimation as it was; `touched` says that it must not be used any more.
LoadedState load_state(const std::string& path, const Config& config, Estimation& estimation,
                       bool& touched);

}  // namespace framewatch::daemon
