// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace framewatch::daemon {

inline constexpr int kMinutesOfDay = 1440;

/// Returns the minutes since midnight of a text such as "08:00" or "23:59"; nullopt for others.
std::optional<int> read_clock_time(const std::string& text);

/// A part of every day, which may go past midnight. Holds its first minute, not its last.
struct DailySpan {
  int from_min = 0, to_min = 0;
  bool holds(int minute) const {
    return from_min < to_min ? minute >= from_min && minute < to_min
                             : minute >= from_min || minute < to_min;
  }
};
/// Returns the span of a text such as "22:00-07:00"; nullopt for others and for an empty span.
std::optional<DailySpan> read_daily_span(const std::string& text);

/// A time zone of the machine's database, with its summer time.
class TimeZone {
 public:
  /// Returns the zone of a name such as "Europe/Rome" or "UTC"; nullopt for unknown names.
  static std::optional<TimeZone> find(const std::string& name);

  /// Returns the minutes since midnight in the zone. `time_us`: since 1970, UTC.
  int minute_of_day(std::int64_t time_us) const;
  /// Returns the date in the zone, "2026-11-28".
  std::string day(std::int64_t time_us) const;

 private:
  std::shared_ptr<void> zone_;  ///< of GLib
};

}  // namespace framewatch::daemon
