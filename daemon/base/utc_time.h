// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace framewatch::daemon {

// Times outside the years 0 to 9999 are clamped to them.

/// Returns "20261121T231500Z": the time in UTC, rounded down to the second.
std::string utc_stamp(std::int64_t time_us);
/// Returns the time of a text that begins with such a stamp, in microseconds, or nullopt.
std::optional<std::int64_t> read_utc_stamp(std::string_view text);

/// Returns "2026-11-21T23:15:00Z", with milliseconds unless the time is a whole second.
std::string utc_text(std::int64_t time_us);
/// Parses texts of utc_text(), a date, a time without seconds, or seconds since 1970. Returns
/// nullopt for other texts.
std::optional<std::int64_t> read_utc(const std::string& text);

/// Returns "2026-11-21 14:03:10 UTC", or "3.200 s" for a sensor clock that does not count from
/// 1970.
std::string sensor_time_text(std::int64_t time_us);
/// Returns the same text without the day: "14:03:10" or "3.200 s".
std::string sensor_clock_text(std::int64_t time_us);
/// Returns "2026-11-21 14:03:10 UTC (15:03:10 CET)", without the part in parentheses if the
/// machine's zone is UTC.
std::string utc_and_local_text(std::int64_t time_us);

}  // namespace framewatch::daemon
