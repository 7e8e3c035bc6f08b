// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/monitor/history/summary_query.h"
#include "estimator/years/weather_lags.h"

namespace framewatch::daemon {

/// Daily means of weather and use.
struct WeatherTable {
  std::vector<estimator::Covariate> covariates;
  std::map<std::int64_t, std::vector<double>> days;  ///< by day since 1970, UTC; NaN: no value

  /// Returns the means of a day; NaN: no value.
  std::vector<double> of(std::int64_t day) const;
};

/// Reads a table (CSV, plain or .gz): the column "time" (UTC, or seconds since 1970), then
/// covariates with their unit at the end of the name (covariate_unit()). Empty cells and "nan"
/// are no values. Returns nullopt, with every problem, when the file breaks a rule.
std::optional<WeatherTable> read_weather(const std::string& path,
                                         std::vector<std::string>& problems);

/// Returns the covariates of these names. Their units must be known.
std::vector<estimator::Covariate> covariates_of(const std::vector<std::string>& names);

/// Returns the daily means of these covariates in a history, over the hours with readings.
WeatherTable weather_of(const std::vector<WeatherHour>& hours,
                        const std::vector<std::string>& covariates);

/// Returns the hours as a table that read_weather() reads.
std::string weather_csv(const std::vector<WeatherHour>& hours);

}  // namespace framewatch::daemon
