#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"

namespace framewatch::drivers {

/// One channel of a station, as the header of a network's file describes it.
struct StationChannel {
  std::string name;  ///< "NP.8040.01.HNE": network, station, location, channel as far as known
  double step_s = 0;
  std::optional<double>
      start_utc_s;  ///< of the first sample, since 1970; without it time is from 0
  AxisHeader header;
  std::string direction;  ///< for a person, where the header's fields do not say it; else empty
  std::string treatment;  ///< for a person: what was done to its values, what is not used
  std::optional<double> peak_mps2;  ///< that the header states, of either sign
};

/// The record of a channel whose values begin on `line`, so many on each. Its note ends with when
/// it begins, and says when the header's peak is not the values'.
std::optional<Record> station_record(const StationChannel& channel,
                                     const std::vector<double>& accel_mps2, std::int64_t line,
                                     std::size_t per_line, FileProblems& problems);

/// Seconds since 1970 at the beginning of a day in UTC; empty for a date that is none.
std::optional<double> utc_of_date(int year, int month, int day);
std::optional<double> utc_of_day_of_year(int year, int day);
/// Seconds since 1970 at a time of that day; empty for one that is none.
std::optional<double> utc_of(std::optional<double> day_s, double hour, double minute,
                             double second);

}  // namespace framewatch::drivers
