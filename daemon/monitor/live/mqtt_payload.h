// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/config/keys/weather_options.h"

namespace framewatch::daemon {

/// A reading of a covariate, in raw units.
struct MqttReading {
  double value = 0;
  std::optional<std::int64_t> time_us = {};  ///< UTC since 1970, if the covariate has a time_field
};

/// Finds the reading of a covariate in the payload of its topic. Returns nullopt, with `problem`,
/// if there is no finite number or no time where the settings expect one.
std::optional<MqttReading> read_mqtt_payload(const std::string& payload,
                                             const WeatherSettings& covariate,
                                             std::string& problem);

}  // namespace framewatch::daemon
