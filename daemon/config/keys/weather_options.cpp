// SPDX-License-Identifier: MIT
#include "daemon/config/keys/weather_options.h"

#include <algorithm>
#include <iterator>

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;

constexpr double kNever = std::numeric_limits<double>::infinity(), kDay_s = 86400;
/// A change from degC to degF is larger than this jump above -4 degC.
constexpr CovariateUnit kUnits[] = {{"_degc", "degC", -60, 80, 10, 25, 3 * kDay_s, true},
                                    {"_pct", "%", 0, 100, 10, kNever, 0, false},
                                    {"_mps", "m/s", 0, 100, 10, kNever, 7 * kDay_s, false},
                                    {"_wpm2", "W/m^2", 0, 1500, 300, kNever, 7 * kDay_s, false}};

const Option kWeather[] = {
    {.key = "name",
     .required = true,
     .meaning = "Unique name that ends with the unit: `_degc` (temperature, -60 to 80), `_pct` "
                "(humidity, occupancy or additional mass, 0 to 100 %), `_mps` (wind, 0 to 100 "
                "m/s), `_wpm2` (sun, 0 to 1500 W/m^2).",
     .target = into<&WeatherSettings::name>},
    {.key = "source",
     .type = table,
     .meaning = "Where readings come from. Default: `{ lcm = \"WEATHER\" }`.",
     .by_hand = "a table with its own section"},
    {.key = "scale",
     .range = {-1e12, 1e12},
     .meaning = "Factor on raw values; not 0.",
     .target = into<&WeatherSettings::scale>},
    {.key = "offset",
     .range = {-1e6, 1e6},
     .meaning = "Subtracted after scaling, such as 273.15 for kelvin.",
     .target = into<&WeatherSettings::offset>},
    {.key = "away_after_s",
     .unit = "s",
     .range = {60, 31536000},
     .meaning = "Without a valid reading for this time, an event says that the covariate is away.",
     .target = into<&WeatherSettings::away_after_s>},
    {.key = "stuck_after_s",
     .unit = "s",
     .no_default = true,
     .range = {0, 31536000},
     .meaning = "Readings that have not changed for this time are rejected. 0: never. Default: 3 "
                "days for temperatures, 7 for wind and sun, never for `_pct`.",
     .target = into<&WeatherSettings::stuck_after_s>},
};

const Option kWeatherSource[] = {
    {.key = "lcm",
     .meaning = "LCM channel of weather_t messages, which tell the covariate's name.",
     .target = into<&WeatherSettings::lcm_channel>},
    {.key = "thermometer",
     .meaning = "LCM channel of temperature_t messages.",
     .target = into<&WeatherSettings::thermometer>},
    {.key = "can",
     .meaning = "Interface of a [[can]] table.",
     .target = into<&WeatherSettings::can>},
    {.key = "dbc_signal",
     .meaning = "Message.Signal of its DBC files. A frame counts at the time of the newest sample.",
     .target = into<&WeatherSettings::dbc_signal>},
};

}  // namespace

const CovariateUnit* covariate_unit(std::string_view name) {
  const auto found = std::find_if(std::begin(kUnits), std::end(kUnits),
                                  [&](const auto& u) { return name.ends_with(u.ending); });
  return found == std::end(kUnits) ? nullptr : found;
}

std::string covariate_endings() {
  std::string out;
  for (const CovariateUnit& u : kUnits) {
    if (!out.empty()) out += &u + 1 == std::end(kUnits) ? " or " : ", ";
    out += u.ending;
  }
  return out;
}

std::vector<OptionSection> weather_options() {
  return {{"weather", kWeather, Reach::restart},
          {"weather.source", kWeatherSource, Reach::restart}};
}

}  // namespace framewatch::daemon
