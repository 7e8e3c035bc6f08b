#include "daemon/monitor/history/history_retention.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/base/sqlite_file.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/raw_log_care.h"
#include "drivers/files/input_file.h"

namespace framewatch::daemon {
namespace {

constexpr double kGigabyte = 1e9;

/// Times around events that show the building, not the instruments. Empty optional: not known.
std::optional<std::vector<TimeSpan>> spans_of_events(const HistorySettings& settings) {
  const std::string path = summary_file(settings.directory);
  std::vector<TimeSpan> out;
  if (drivers::is_absent(path)) return out;
  SqliteFile file;
  if (!file.open_to_read(path)) return std::nullopt;
  SqliteStatement events = file.prepare(
      "SELECT min(since_us, time_us), time_us FROM event"
      " WHERE state = 1 AND kind IN ('stiffness_change', 'gap')");
  while (events.row())
    out.push_back(
        {events.integer(0) - static_cast<std::int64_t>(kSecond_us * settings.event_before_s),
         events.integer(1) + static_cast<std::int64_t>(kSecond_us * settings.event_after_s)});
  if (file.failed()) return std::nullopt;
  return out;
}

}  // namespace

void remove_old_raw_logs(const HistorySettings& settings, std::int64_t now_us) {
  std::vector<RawLog> logs = raw_logs(raw_folder(settings.directory));
  std::int64_t bytes = 0;
  for (const RawLog& raw : logs) bytes += raw.bytes;
  const auto most_bytes = static_cast<std::int64_t>(kGigabyte * settings.keep_gb);
  const auto oldest_us = now_us - static_cast<std::int64_t>(kDay_us * settings.keep_days);
  std::optional<std::vector<TimeSpan>> spans;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    // A log ends where the next one starts.
    const bool old = i + 1 < logs.size() && logs[i + 1].start_us < oldest_us;
    if (logs[i].partial || (!old && bytes <= most_bytes)) continue;
    if (!spans && !(spans = spans_of_events(settings))) return;
    const std::string problem =
        excerpt_raw_log(logs[i].path, *spans, event_folder(settings.directory));
    std::error_code failure;
    if (problem.empty()) std::filesystem::remove(logs[i].path, failure);
    if (!problem.empty() || failure) {
      log(LogLevel::warning, fmt::format("history: {} stays: {}", logs[i].path,
                                         problem.empty() ? failure.message() : problem));
      continue;
    }
    bytes -= logs[i].bytes;
  }
}

}  // namespace framewatch::daemon
