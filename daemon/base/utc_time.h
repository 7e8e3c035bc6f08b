#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace framewatch::daemon {

// Texts are of years 0 to 9999; a time beyond them is written as the nearest of these.

/// "20261121T231500Z": a time in UTC, rounded down to the second.
std::string utc_stamp(std::int64_t time_us);
/// The time of a text that begins with such a stamp, microseconds; empty when it does not.
std::optional<std::int64_t> read_utc_stamp(std::string_view text);

/// "2026-11-21T23:15:00Z", with milliseconds when the time is no whole second.
std::string utc_text(std::int64_t time_us);
/// Reads what utc_text() writes, a date alone, a time without seconds, or seconds since 1970.
/// Empty when the text is no time.
std::optional<std::int64_t> read_utc(const std::string& text);

/// For people: "2026-11-21 14:03:10 UTC"; "3.200 s" for a sensor clock that does not count from
/// 1970.
std::string sensor_time_text(std::int64_t time_us);
/// The same without the day: "14:03:10"; "3.200 s" likewise.
std::string sensor_clock_text(std::int64_t time_us);
/// For people at this machine: "2026-11-21 14:03:10 UTC (15:03:10 CET)"; without what is in
/// brackets where the machine's zone is UTC.
std::string utc_and_local_text(std::int64_t time_us);

}  // namespace framewatch::daemon
