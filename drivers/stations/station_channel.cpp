// SPDX-License-Identifier: MIT
#include "drivers/stations/station_channel.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/core.h>

#include "drivers/records/record_builder.h"

namespace framewatch::drivers {
namespace {

constexpr double kPeakTolerance = 0.01;

std::optional<double> seconds_of(std::chrono::year_month_day date) {
  if (!date.ok()) return std::nullopt;
  return 86400.0 * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

std::string start_text(double utc_s) {
  utc_s += 0.0005;  // round to the millisecond, do not truncate
  const double whole_s = std::floor(utc_s);
  return fmt::format("begins {:%Y-%m-%dT%H:%M:%S}.{:03}Z",
                     fmt::gmtime(static_cast<std::time_t>(whole_s)),
                     static_cast<int>((utc_s - whole_s) * 1000));
}

}  // namespace

std::optional<double> utc_of_date(int year, int month, int day) {
  if (year < 1 || year > 9999 || month < 1 || month > 12 || day < 1 || day > 31)
    return std::nullopt;
  return seconds_of({std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                     std::chrono::day(static_cast<unsigned>(day))});
}

std::optional<double> utc_of_day_of_year(int year, int day) {
  const auto first = utc_of_date(year, 1, 1);
  const int days = std::chrono::year(year).is_leap() ? 366 : 365;
  if (!first || day < 1 || day > days) return std::nullopt;
  return *first + 86400.0 * (day - 1);
}

std::optional<double> utc_of(std::optional<double> day_s, double hour, double minute,
                             double second) {
  const bool sound =
      hour >= 0 && hour < 24 && minute >= 0 && minute < 60 && second >= 0 && second < 61;
  if (!day_s || !sound) return std::nullopt;
  return *day_s + 3600 * hour + 60 * minute + second;
}

std::optional<Record> station_record(const StationChannel& channel,
                                     const std::vector<double>& accel_mps2, std::int64_t line,
                                     std::size_t per_line, FileProblems& problems) {
  check_names({channel.name}, 0, problems);
  if (channel.start_utc_s && !(std::abs(*channel.start_utc_s) < RecordBuilder::kMaxTimeS))
    problems.add(0,
                 fmt::format("it begins at {:g} s, which is out of range", *channel.start_utc_s));
  if (problems.any()) return std::nullopt;
  RecordBuilder builder({channel.name}, problems);
  builder.expect(1 / channel.step_s, 0);
  double peak_mps2 = 0;
  for (std::size_t i = 0; i < accel_mps2.size() && !builder.full(); ++i) {
    builder.add(line + static_cast<std::int64_t>(i / per_line),
                channel.start_utc_s.value_or(0) + static_cast<double>(i) * channel.step_s,
                {&accel_mps2[i], 1});
    peak_mps2 = std::max(peak_mps2, std::abs(accel_mps2[i]));
  }
  builder.note(
      fmt::format("{}: {}{}{}", channel.name,
                  channel.direction.empty() ? direction_text(channel.header) : channel.direction,
                  channel.header.place.empty() ? "" : ", ", channel.header.place));
  builder.note(channel.treatment +
               (channel.start_utc_s ? "; " + start_text(*channel.start_utc_s) : ""));
  if (channel.peak_mps2 &&
      std::abs(std::abs(*channel.peak_mps2) - peak_mps2) > kPeakTolerance * peak_mps2)
    builder.note(fmt::format("the header says a peak of {:.4g} m/s2, the values have {:.4g}",
                             std::abs(*channel.peak_mps2), peak_mps2));
  auto record = builder.finish();
  if (record) {
    record->rate_hz = 1 / channel.step_s;  // more exact than the step between rounded times
    record->headers = {channel.header};
  }
  return record;
}

std::optional<Record> merge_channels(std::vector<Record> records, FileProblems& problems) {
  if (problems.any()) return std::nullopt;
  if (records.size() == 1) return std::move(records.front());
  std::vector<Problem> found;
  const std::vector<std::string> where(records.size(), problems.path());
  auto merged = merge_records(std::move(records), where, MergeSpan::common, found);
  for (const Problem& problem : found) problems.add(0, problem.message);
  return merged;
}

}  // namespace framewatch::drivers
