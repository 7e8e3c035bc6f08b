#pragma once

#include <cstdint>
#include <string>

namespace framewatch::daemon {

/// How often the daemon has begun with a state file, kept beside it as STATE.starts: a daemon that
/// comes and goes is seen although each of its lives looks well.
struct StartCount {
  std::int64_t starts = 0;          ///< this one included; 0: none is kept
  std::int64_t unclean_starts = 0;  ///< of them after a run that nobody had told to stop
};

/// Counts one more start. A file that is not there or not readable begins at nothing. problem:
/// empty, or why the count could not be stored.
StartCount count_start(const std::string& state_path, std::string& problem);
/// The run ends because it was told to. Empty, or why that could not be stored.
std::string count_clean_stop(const std::string& state_path, const StartCount& count);

}  // namespace framewatch::daemon
