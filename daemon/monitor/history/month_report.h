// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/history/weather_table.h"

namespace framewatch::daemon {

/// A month of the calendar, UTC.
struct Month {
  int year = 1970, month = 1;  ///< 1 to 12

  /// Returns the month that holds a time.
  static Month of(std::int64_t time_us);
  Month before() const;
  std::int64_t start_us() const;
  std::int64_t end_us() const;  ///< start of the next month
  std::string name() const;     ///< "2026-11"
  int days() const;
};

/// Report about a month for the owner of a building.
struct MonthReport {
  std::string building;
  Month month;
  std::vector<std::string> sentences;  ///< what changed, what is healthy, coverage, events, disk
  bool changed = false;                ///< a loss was found in this month
  std::string page;                    ///< HTML, self-contained
};

/// Reads a month of the history, and all days before it to know what is usual. `config` has a
/// history. weather: nullopt for that of the history. Returns nullopt, without a problem, if the
/// history begins after the month. Returns nullopt and sets `problem` if the history cannot be
/// read. `now_us`: host clock.
std::optional<MonthReport> month_report(const Config& config,
                                        const std::optional<WeatherTable>& weather,
                                        const Month& month, std::int64_t now_us,
                                        std::string& problem);

}  // namespace framewatch::daemon
