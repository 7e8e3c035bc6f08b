// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace framewatch::daemon {

/// A unit of weather and use, and what a covariate in it can be and do. Names of covariates end
/// with it.
struct CovariateUnit {
  std::string_view ending, unit;
  double least, most;                                     ///< possible values
  double scale;                                           ///< see estimator::Covariate
  double jump = std::numeric_limits<double>::infinity();  ///< larger changes in a day are errors
  double stuck_after_s = 0;  ///< an unchanged value is an error after this time; 0: never
  bool freezes = false;      ///< see estimator::Covariate
};

/// Returns the unit at the end of a covariate's name, or null.
const CovariateUnit* covariate_unit(std::string_view name);
/// Returns the endings for messages: "_degc, _pct, _mps or _wpm2".
std::string covariate_endings();

/// [[weather]]: one condition that may change the building.
struct WeatherSettings {
  std::string name;
  std::string lcm_channel = "WEATHER";  ///< of weather_t messages
  std::string thermometer = {};         ///< LCM channel of temperature_t messages; empty: none
  std::string can = {}, dbc_signal = {};
  std::string mqtt = {};   ///< topic; empty: none
  std::string field = {};  ///< JSON pointer of the value in a payload; empty: the whole payload
  std::string time_field = {};   ///< JSON pointer of the time; empty: none
  double scale = 1, offset = 0;  ///< value = scale * raw - offset
  double away_after_s = 21600;
  double stuck_after_s = 0;  ///< 0: never
};

}  // namespace framewatch::daemon
