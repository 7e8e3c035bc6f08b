// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace framewatch::daemon {

/// Counts the starts of the daemon with one state file, in the file STATE.starts beside it. Shows a
/// daemon that keeps crashing and restarting.
struct StartCount {
  std::int64_t starts = 0;          ///< including this one; 0: not counted
  std::int64_t unclean_starts = 0;  ///< starts after a run that did not stop cleanly
};

/// Adds one start to the count beside the state file `state_path`, and returns the new count. An
/// unreadable or missing count is taken as zero. Sets `problem` to why the count cannot be stored,
/// or to an empty string.
StartCount count_start(const std::string& state_path, std::string& problem);
/// Records that this run stops cleanly. Returns an empty string, or why that could not be stored.
std::string count_clean_stop(const std::string& state_path, const StartCount& count);

}  // namespace framewatch::daemon
