#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace framewatch::daemon {

/// Places in a history's directory.
std::string raw_folder(const std::string& directory);    ///< raw logs
std::string event_folder(const std::string& directory);  ///< what of them is kept for ever
std::string summary_file(const std::string& directory);  ///< the SQLite database

/// A raw log, as its name describes it.
struct RawLog {
  std::string path;
  std::int64_t start_us = 0;  ///< sensor time of its first samples, to the second before
  std::int64_t bytes = 0;
  bool partial = false;  ///< still written, or left by a program that was killed
  bool compressed = false;
};

/// Path of a new raw log; creates its folders.
std::string new_raw_log(const std::string& directory, std::int64_t start_us);

/// The raw logs in a folder, in order of time. A log is named as partial, then plain, then
/// compressed; when two names exist the later one counts. A log may get its next name before it is
/// opened.
std::vector<RawLog> raw_logs(const std::string& folder);
/// The plain name of a partial log, which it gets when it is closed and before it is compressed.
std::string closed_path(const RawLog& log);

}  // namespace framewatch::daemon
