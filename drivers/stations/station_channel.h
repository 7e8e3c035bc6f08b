// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"

namespace framewatch::drivers {

/// Describes one channel of a station as the header of a network's file does.
struct StationChannel {
  std::string name;  ///< "NP.8040.01.HNE": network, station, location and channel, if known
  double step_s = 0;
  std::optional<double> start_utc_s;  ///< first sample, since 1970; empty: time starts at 0
  AxisHeader header;
  std::string direction;            ///< for a person, when `header` cannot express it; else empty
  std::string treatment;            ///< for a person: how values were processed, what is not used
  std::optional<double> peak_mps2;  ///< peak stated in the file, of either sign
};

/// Returns the record of a channel. The file holds `per_line` values on each line from `line` on.
/// Notes say when the record begins and whether its peak differs from the peak stated. Returns
/// nullopt with a problem when the name, the start or the values break a rule.
std::optional<Record> station_record(const StationChannel& channel,
                                     const std::vector<double>& accel_mps2, std::int64_t line,
                                     std::size_t per_line, FileProblems& problems);

/// Merges the channels of one file, which have the instants that all of them have. Returns nullopt
/// when there is any problem, also one that the caller reported.
std::optional<Record> merge_channels(std::vector<Record> records, FileProblems& problems);

/// Begins the line that ends a channel's data in COSMOS and CSMIP files.
inline constexpr std::string_view kEndOfChannel = "/&";

/// Returns the seconds since 1970 at the beginning of a day in UTC. Returns nullopt for an invalid
/// date.
std::optional<double> utc_of_date(int year, int month, int day);
/// Returns the same for the day of a year, counted from 1.
std::optional<double> utc_of_day_of_year(int year, int day);
/// Returns the seconds since 1970 at a time of the day that begins at `day_s`. Returns nullopt for
/// an invalid time, or when `day_s` is empty.
std::optional<double> utc_of(std::optional<double> day_s, double hour, double minute,
                             double second);

}  // namespace framewatch::drivers
