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

/// Finds the reading of a covariate in the payload of its topic. Returns nullopt and sets `problem`
/// if the value is not a finite number, or if the settings name a time and it cannot be read.
std::optional<MqttReading> read_mqtt_payload(const std::string& payload,
                                             const WeatherSettings& covariate,
                                             std::string& problem);

}  // namespace framewatch::daemon
