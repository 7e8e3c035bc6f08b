// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace framewatch::drivers {

constexpr double kStandardGravity_mps2 = 9.80665;
constexpr double kGal_mps2 = 0.01;

/// Returns the m/s^2 in one of a unit of acceleration: "g" (9.80665), "mg", "gal" (0.01), "mps2",
/// "m/s2", "m/s^2", "cm/s2", "mm/s^2" and similar spellings. Returns nullopt for any other text.
std::optional<double> mps2_per(std::string_view unit);

/// Returns the newtons in one of a unit of force, "N" or "kN". Returns nullopt for any other text.
std::optional<double> newtons_per(std::string_view unit);

/// Parses the value of --unit: a unit of acceleration, or a positive number of m/s^2 (for example
/// per count of a converter). Returns nullopt for any other text.
std::optional<double> declared_unit(std::string_view text);

/// Returns the seconds in one of a unit of time: "s", "ms", "us", "ns" and similar spellings.
/// Returns nullopt for any other text.
std::optional<double> seconds_per(std::string_view unit);

/// A time stamp of a file, such as "2026-11-21T17:00:00.01Z".
struct TimeStamp {
  double local_s = 0;             ///< since 1970, local time
  std::optional<int> offset_min;  ///< local time minus UTC; empty: the stamp has no zone
};

/// Parses a time stamp: 2026-11-21T17:00:00.01Z or 21.11.2026 17:00:00. A blank may stand for the
/// T; the zone is Z, an offset such as +09:00, or missing. Returns nullopt for any other text, also
/// when a field is out of range.
std::optional<TimeStamp> parse_time_stamp(std::string_view text);

/// Parses "Z", "UTC" or "+09:00" to minutes. Returns nullopt for any other text.
std::optional<int> parse_zone(std::string_view text);

/// Returns why a text that is neither a number nor a TimeStamp is not a time, with what to write
/// instead. Recognizes ambiguous dates and times without a date.
std::string why_no_time(std::string_view text);

}  // namespace framewatch::drivers
