#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace framewatch::drivers {

/// A time stamp of a file: "2026-11-21T17:00:00.01Z" or with a blank for the T; the zone is Z, an
/// offset such as +09:00, or not there.
struct TimeStamp {
  double local_s = 0;             ///< since 1970, by the clock on the wall
  std::optional<int> offset_min;  ///< of that clock ahead of UTC
};

/// Empty when it is none, also when a field is out of its range.
std::optional<TimeStamp> parse_time_stamp(std::string_view text);

/// "Z", "UTC" or "+09:00" in minutes; empty for anything else.
std::optional<int> parse_zone(std::string_view text);

/// Why a text that is neither a number nor a TimeStamp is no time, with what helps: dates whose day
/// and month can be exchanged, times without a date.
std::string why_no_time(std::string_view text);

}  // namespace framewatch::drivers
