#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/estimation/estimation.h"

namespace framewatch::daemon {

/// A section that was not taken from a state file.
struct LostSection {
  std::string name;
  std::string why;  ///< "its digest is another"
};

/// What an estimation does without a section, for a person: "the window begins anew". Empty for a
/// name that is not a section's.
std::string_view without_section(std::string_view name);

/// The sections of the configuration file, and the further properties in StateGrounds, that a
/// section of the state depends on. It is refused when one of them has changed.
const std::vector<std::string>& grounds_of_section(std::string_view name);

/// The state of an estimation as it goes into a file (docs/formats.md).
struct SavedState {
  std::string config_sha256;
  std::int64_t events_before = 0;              ///< events that an output has so far
  std::map<std::string, std::string> grounds;  ///< what sections rest on, and its digest
  std::vector<StateSection> sections;
};
SavedState saved_state(const Config& config, Estimation& estimation, std::int64_t events_before);

/// The bytes of a state file: head with the digest of every section, digest of the head, sections.
std::vector<std::uint8_t> state_bytes(const SavedState& state);

/// Writes a state file to PATH.partial and renames it when it is on the disk. Empty on success,
/// else the problem.
std::string write_state(const std::string& path, const SavedState& state);

struct LoadedState {
  std::string problem;  ///< why nothing was taken; empty when something was
  std::int64_t events_before = 0;
  std::vector<LostSection> lost;  ///< sections that were not taken
};
/// Loads a whole state file into an estimation of the same configuration, or nothing of it. A
/// problem found in the file itself leaves the estimation as it was; `touched` says that it must
/// not be used any more.
LoadedState load_state(const std::string& path, const Config& config, Estimation& estimation,
                       bool& touched);

/// Loads every section of a state file that fits, also when the configuration differs in what the
/// others rest on. estimation: of `config`, as new. anew: gives another one as new in its place,
/// because it was spoilt.
LoadedState load_what_fits(const std::string& path, const Config& config, Estimation& estimation,
                           const std::function<Estimation&()>& anew);

}  // namespace framewatch::daemon
