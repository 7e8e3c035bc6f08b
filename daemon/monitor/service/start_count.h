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

/// Counts one more start. Starts from zero if there is no readable file. Sets `problem` to the
/// reason if the count cannot be stored, else to an empty string.
StartCount count_start(const std::string& state_path, std::string& problem);
/// Records that this run stops cleanly. Returns an empty string, or why that could not be stored.
std::string count_clean_stop(const std::string& state_path, const StartCount& count);

}  // namespace framewatch::daemon
