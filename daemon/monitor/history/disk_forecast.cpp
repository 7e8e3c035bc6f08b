// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/disk_forecast.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <system_error>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/process.h"
#include "daemon/monitor/history/history_days.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/summary_query.h"

namespace framewatch::daemon {
namespace {

constexpr double kFarthest_days = 3652;
constexpr double kLeastSpan_days = 1.0 / 24;
constexpr double kGb = 1e9;

double days_between(std::int64_t from_us, std::int64_t to_us) {
  return static_cast<double>(to_us - from_us) / static_cast<double>(kDay_us);
}

double file_bytes(const std::string& path) {
  std::error_code none;
  const auto bytes = std::filesystem::file_size(path, none);
  return none ? 0 : static_cast<double>(bytes);
}

/// Returns the closed logs in their final form, in order of time.
std::vector<RawLog> final_logs(const HistorySettings& s) {
  std::vector<RawLog> logs = raw_logs(raw_folder(s.directory));
  std::erase_if(logs, [&](const RawLog& l) { return l.partial || l.compressed != s.compress; });
  return logs;
}

}  // namespace

std::optional<double> days_until_full(const HistorySettings& s, const HistoryGrowth& g) {
  const double most_raw = std::min(kGb * s.keep_gb, g.raw_bytes_per_day * s.keep_days);
  const double raw_left = std::max(0.0, most_raw - g.raw_bytes);
  const double together = g.raw_bytes_per_day + g.other_bytes_per_day;
  // First the raw logs grow too, then only what stays.
  const double raw_days = g.raw_bytes_per_day > 0 ? raw_left / g.raw_bytes_per_day : 0;
  double days = kFarthest_days + 1;
  if (g.free_bytes <= together * raw_days)
    days = together > 0 ? g.free_bytes / together : 0;
  else if (g.other_bytes_per_day > 0)
    days = raw_days + (g.free_bytes - together * raw_days) / g.other_bytes_per_day;
  if (days > kFarthest_days) return std::nullopt;
  return std::max(0.0, days);
}

std::optional<HistoryGrowth> history_growth(const HistorySettings& s, std::int64_t now_us) {
  HistoryGrowth out;
  const std::int64_t free_bytes = disk_free_bytes(s.directory);
  SummaryQuery summaries;
  if (free_bytes < 0 || !summaries.open(s.directory).empty()) return std::nullopt;
  out.free_bytes = static_cast<double>(free_bytes);
  std::int64_t first_us = now_us;
  for (const SummaryPeriods& p : summaries.periods()) first_us = std::min(first_us, p.first_us);
  const double age_days = days_between(first_us, now_us);
  if (age_days < kLeastSpan_days) return std::nullopt;
  double others = file_bytes(summary_file(s.directory));
  for (const RawLog& log : raw_logs(event_folder(s.directory)))
    others += static_cast<double>(log.bytes);
  out.other_bytes_per_day = others / age_days;
  const std::vector<RawLog> logs = final_logs(s);
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const auto bytes = static_cast<double>(logs[i].bytes);
    out.raw_bytes += bytes;
    // The newest log ends at an unknown time, so the span lasts until its start.
    if (i + 1 < logs.size()) out.raw_bytes_per_day += bytes;
  }
  const double span_days =
      logs.size() < 2 ? 0 : days_between(logs.front().start_us, logs.back().start_us);
  out.raw_bytes_per_day = span_days >= kLeastSpan_days ? out.raw_bytes_per_day / span_days : 0;
  return out;
}

std::string disk_sentence(std::optional<double> days, std::int64_t now_us) {
  if (!days) return "the disk has room for 10 years or more";
  const double full_us = static_cast<double>(now_us) + *days * static_cast<double>(kDay_us);
  const auto day = static_cast<std::int64_t>(full_us / static_cast<double>(kDay_us));
  return fmt::format("the disk is full in about {} ({})", days_text(static_cast<int>(*days)),
                     day_text(day));
}

}  // namespace framewatch::daemon
