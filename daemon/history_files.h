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

/// One raw log, as its name tells.
struct RawLog {
  std::string path;
  std::int64_t start_us = 0;  ///< sensor time of its first samples, to the second before
  std::int64_t bytes = 0;
  bool partial = false;  ///< still written, or left by a program that was killed
  bool compressed = false;
};

/// Path of a raw log that is not there yet; makes the folders.
std::string new_raw_log(const std::string& directory, std::int64_t start_us);

/// The raw logs in a folder, in order of time; of one that is there under two names the later one:
/// it is partial, then plain, then compressed. Who opens one may find that it has the next name.
std::vector<RawLog> raw_logs(const std::string& folder);
/// The name of a log that is or was partial, when it is closed and not yet compressed.
std::string closed_path(const RawLog& log);

/// "2026-11-21T23:15:00Z", by sensor time; "2026-11-21T23:15:00.250Z" when that is no whole second.
std::string utc_text(std::int64_t time_us);
/// Reads the same, a date alone, a time without seconds, or seconds since 1970. Empty: it is none.
std::optional<std::int64_t> read_utc(const std::string& text);

}  // namespace framewatch::daemon
