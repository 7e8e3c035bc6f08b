// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace framewatch::daemon {

/// The effect of every day's weather on the elements, learned from daily means (YearsWatch).
struct WeatherEffects {
  std::vector<std::string> covariates;                ///< empty: the season stands for the weather
  std::map<std::int64_t, Eigen::VectorXd> weather;    ///< regressors by day since 1970, UTC
  std::map<std::string, Eigen::VectorXd> by_element;  ///< on the logarithm of the value
  Eigen::VectorXd mean;                               ///< of the regressors of all days

  /// Computes `mean` from `weather`.
  void find_mean();
  bool empty() const { return by_element.empty() || weather.empty(); }
  bool knows(const std::string& element) const { return by_element.contains(element); }
  /// Returns the logarithm of an element's value in the weather of a time over its value in the
  /// mean weather of all days. Between noon and noon it is interpolated. Where days are missing,
  /// the day before stands for them until noon two days later. NaN: not known.
  double at(const std::string& element, std::int64_t time_us) const;
  /// Returns the mean of at() over the days of [from_us, to_us) whose weather is known, or at() the
  /// middle if that is less than two days. NaN: not known.
  double over(const std::string& element, std::int64_t from_us, std::int64_t to_us) const;
};

}  // namespace framewatch::daemon
