// SPDX-License-Identifier: MIT
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

/// A section that could not be loaded from a state file.
struct LostSection {
  std::string name;
  std::string why;  ///< "is damaged: its digest does not match"
};

/// Returns the consequence of a missing section, for people: "the window starts empty". Empty if
/// `name` is not a section.
std::string_view without_section(std::string_view name);

/// The state of an estimation in the form of a file (docs/formats.md).
struct SavedState {
  std::string config_sha256;
  std::int64_t events_before = 0;              ///< events that an output already has
  std::map<std::string, std::string> grounds;  ///< digests of what sections depend on
  std::vector<StateSection> sections;
};

SavedState saved_state(const Config& config, Estimation& estimation, std::int64_t events_before);

/// Returns the bytes of a state file: head with the digest of every section, digest of the head,
/// sections.
std::vector<std::uint8_t> state_bytes(const SavedState& state);

/// Writes a state file to PATH.partial and renames it when it is on the disk. Returns an empty
/// string, or the problem.
std::string write_state(const std::string& path, const SavedState& state);

struct LoadedState {
  std::string problem;  ///< why nothing was loaded; empty when something was
  std::int64_t events_before = 0;
  std::vector<LostSection> lost = {};  ///< sections that were not loaded
};
/// Loads a whole state file into an estimation of the same configuration, or nothing. A problem of
/// the file itself leaves the estimation unchanged; `touched` is set if it must not be used any
/// more.
LoadedState load_state(const std::string& path, const Config& config, Estimation& estimation,
                       bool& touched);

/// Loads every section of a state file that fits, even if the configuration differs in what the
/// others depend on. `estimation` must be new and of `config`. Calls `anew` for another new one in
/// its place when a section has spoiled it.
LoadedState load_what_fits(const std::string& path, const Config& config, Estimation& estimation,
                           const std::function<Estimation&()>& anew);

}  // namespace framewatch::daemon
