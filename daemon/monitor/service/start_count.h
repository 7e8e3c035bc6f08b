#pragma once

#include <cstdint>
#include <string>

namespace framewatch::daemon {

/// How often the daemon was started with a state file, stored beside it as STATE.starts: shows a
/// daemon that keeps crashing and restarting.
struct StartCount {
  std::int64_t starts = 0;          ///< including this one; 0: not counted
  std::int64_t unclean_starts = 0;  ///< after a run that was not told to stop
};

/// Counts one more start; from zero when there is no readable file. problem:
/// empty, or why the count could not be stored.
StartCount count_start(const std::string& state_path, std::string& problem);
/// Records that the run ends because it was told to. Empty, or why that could not be stored.
std::string count_clean_stop(const std::string& state_path, const StartCount& count);

}  // namespace framewatch::daemon
