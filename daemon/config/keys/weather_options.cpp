// SPDX-License-Identifier: MIT
#include "daemon/config/keys/weather_options.h"

#include <algorithm>
#include <iterator>

#include "daemon/config/keys/option_table.h"
#include "drivers/mqtt/mqtt_settings.h"

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
    {.key = "mqtt",
     .meaning =
         "Topic of the broker of [mqtt], without wildcards. A payload is a number, or JSON if "
         "there is a field.",
     .target = into<&WeatherSettings::mqtt>},
    {.key = "field",
     .meaning = "JSON pointer of the value in a payload of mqtt, such as `/temperature` or "
                "`/sensors/0/value`.",
     .target = into<&WeatherSettings::field>},
    {.key = "time_field",
     .meaning =
         "JSON pointer of the time in a payload of mqtt: ISO 8601, or seconds or milliseconds "
         "since 1970. Without it a reading counts at the time of the newest sample, and "
         "retained messages are ignored.",
     .target = into<&WeatherSettings::time_field>},
};

const Option kMqtt[] = {
    {.key = "url",
     .required = true,
     .meaning = "Address of the broker: `mqtts://HOST[:PORT]` with TLS, or `mqtt://HOST[:PORT]`. "
                "Ports by default: 8883, 1883.",
     .target = into<&drivers::MqttSettings::url>},
    {.key = "ca_file",
     .meaning = "CA certificates (PEM) for the broker, instead of the system's. Files are read for "
                "each connection.",
     .is_path = true,
     .target = into<&drivers::MqttSettings::ca_file>},
    {.key = "certificate_file",
     .meaning = "Certificate (PEM) by which the broker knows framewatch; belongs with key_file.",
     .is_path = true,
     .target = into<&drivers::MqttSettings::certificate_file>},
    {.key = "key_file",
     .meaning = "Private key (PEM) of certificate_file, without a passphrase.",
     .is_path = true,
     .target = into<&drivers::MqttSettings::key_file>},
    {.key = "user",
     .meaning = "User name at the broker.",
     .target = into<&drivers::MqttSettings::user>},
    {.key = "password_file",
     .meaning = "File whose first line is the password of user.",
     .is_path = true,
     .target = into<&drivers::MqttSettings::password_file>},
    {.key = "client_id",
     .meaning =
         "Name of this connection; must differ between all clients of the broker. Default: a "
         "random one.",
     .target = into<&drivers::MqttSettings::client_id>},
    {.key = "keepalive_s",
     .unit = "s",
     .range = {5, 3600},
     .meaning = "After this time without a message the broker must show that it is there.",
     .target = into<&drivers::MqttSettings::keepalive_s>},
    {.key = "queue_capacity",
     .unit = "messages",
     .range = {1, 100000},
     .meaning = "Messages that may wait; further ones are dropped and counted.",
     .target = into<&drivers::MqttSettings::queue_capacity>},
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
          {"weather.source", kWeatherSource, Reach::restart},
          {"mqtt", kMqtt, Reach::restart}};
}

}  // namespace framewatch::daemon
