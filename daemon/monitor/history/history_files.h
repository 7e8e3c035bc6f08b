// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace framewatch::daemon {

/// Later than any time in a history; -kEver_us is earlier than any.
inline constexpr std::int64_t kEver_us = INT64_MAX / 4;
inline constexpr std::int64_t kHour_s = 3600;

/// Paths in a history's directory.
std::string raw_folder(const std::string& directory);    ///< raw logs
std::string event_folder(const std::string& directory);  ///< raw samples of events, kept forever
std::string summary_file(const std::string& directory);  ///< the SQLite database

/// A raw log, as described by its name.
struct RawLog {
  std::string path;
  std::int64_t start_us = 0;  ///< sensor time of the first samples, rounded down to seconds
  std::int64_t bytes = 0;
  bool partial = false;  ///< still being written, or left by a killed program
  bool compressed = false;
};

/// Returns the path of a new raw log; creates its folders.
std::string new_raw_log(const std::string& directory, std::int64_t start_us);

/// Returns the raw logs in a folder, in order of time. The name of a log is first partial, then
/// plain, then compressed; if two names exist, the later one counts. A log may be renamed before
/// the caller opens it.
std::vector<RawLog> raw_logs(const std::string& folder);
/// Returns the plain name of a log, which it has between closing and compression.
std::string closed_path(const RawLog& log);

}  // namespace framewatch::daemon
