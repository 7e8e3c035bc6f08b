// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/history_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/utc_time.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".lcmlog";
constexpr std::string_view kPartial = ".partial", kPacked = ".zst";

std::optional<RawLog> raw_log(const fs::directory_entry& entry) {
  RawLog log;
  log.path = entry.path().string();
  std::string name = entry.path().filename().string();
  const auto take = [&name](std::string_view ending) {
    if (!name.ends_with(ending)) return false;
    name.resize(name.size() - ending.size());
    return true;
  };
  log.partial = take(kPartial);
  log.compressed = take(kPacked);
  if (!take(kEnding) || (log.partial && log.compressed)) return std::nullopt;
  const auto start_us = read_utc_stamp(name);
  if (!start_us) return std::nullopt;
  log.start_us = *start_us;
  std::error_code failure;
  log.bytes = static_cast<std::int64_t>(entry.file_size(failure));
  if (failure == std::errc::no_such_file_or_directory)
    log.bytes = 0;  // it was renamed meanwhile
  else if (failure)
    return std::nullopt;
  return log;
}

}  // namespace

std::string raw_folder(const std::string& directory) {
  return (fs::path(directory) / "raw").string();
}

std::string event_folder(const std::string& directory) {
  return (fs::path(directory) / "events").string();
}

std::string summary_file(const std::string& directory) {
  return (fs::path(directory) / "history.sqlite").string();
}

std::string new_raw_log(const std::string& directory, std::int64_t start_us) {
  const fs::path folder = raw_folder(directory);
  std::error_code none;
  fs::create_directories(folder, none);  // a failure shows when the file is created
  std::string name = utc_stamp(start_us);
  for (int i = 2;; ++i) {
    const std::string path = (folder / (name + kEnding)).string();
    bool there = false;
    for (const char* ending : {"", ".zst", ".partial"})
      there = there || fs::exists(path + ending, none);
    if (!there) return path;
    name = fmt::format("{}_{}", utc_stamp(start_us), i);
  }
}

std::vector<RawLog> raw_logs(const std::string& folder) {
  std::vector<RawLog> out;
  std::error_code none;
  for (fs::directory_iterator at(folder, none), end; !none && at != end; at.increment(none))
    if (const auto log = raw_log(*at)) out.push_back(*log);
  std::ranges::sort(out, {}, [](const RawLog& log) { return std::tie(log.start_us, log.path); });
  const auto there = [&](const std::string& path) {
    return std::any_of(out.begin(), out.end(), [&](const RawLog& log) { return log.path == path; });
  };
  std::vector<RawLog> once;
  for (const RawLog& log : out) {
    const std::string closed = closed_path(log);
    const bool later =
        !log.compressed && ((log.partial && there(closed)) || there(closed + ".zst"));
    if (!later) once.push_back(log);
  }
  return once;
}

std::string closed_path(const RawLog& log) {
  const std::size_t ending = log.partial ? kPartial.size() : log.compressed ? kPacked.size() : 0;
  return log.path.substr(0, log.path.size() - ending);
}

}  // namespace framewatch::daemon
