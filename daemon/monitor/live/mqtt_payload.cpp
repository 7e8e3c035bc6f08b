// SPDX-License-Identifier: MIT
#include "daemon/monitor/live/mqtt_payload.h"

#include <cmath>
#include <cstddef>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/printable.h"
#include "daemon/base/utc_time.h"
#include "drivers/files/number_text.h"

namespace framewatch::daemon {
namespace {

using nlohmann::json;

constexpr std::size_t kShown_bytes = 40;
constexpr double kLeastMilliseconds = 1e11;  // smaller times since 1970 are seconds
constexpr double kMostTime_s = 4e9;

std::string shown(const std::string& text) {
  return "\"" + printable(text.substr(0, kShown_bytes)) + (text.size() > kShown_bytes ? ".." : "") +
         "\"";
}

std::optional<double> finite_number(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return std::nullopt;
  const auto last = text.find_last_not_of(" \t\r\n");
  const std::optional<double> value = drivers::parse_number(text.substr(first, last - first + 1));
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Returns the number of a JSON value; a text may hold one.
std::optional<double> number_of(const json& value) {
  if (value.is_string()) return finite_number(value.get_ref<const std::string&>());
  if (!value.is_number()) return std::nullopt;
  const double number = value.get<double>();
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

/// Returns the seconds of "+01:00" at the end of a time, and removes it; "Z" for zero.
std::int64_t take_zone_s(std::string& text) {
  constexpr std::size_t kZone = 6;  // +01:00
  if (text.size() <= kZone || text.find('T') == std::string::npos) return 0;
  const std::string zone = text.substr(text.size() - kZone);
  const auto digit = [&zone](std::size_t at) {
    return zone[at] >= '0' && zone[at] <= '9' ? zone[at] - '0' : -1;
  };
  if ((zone[0] != '+' && zone[0] != '-') || zone[3] != ':') return 0;
  for (const std::size_t at : {1, 2, 4, 5})
    if (digit(at) < 0) return 0;
  const std::int64_t minutes = 60 * (10 * digit(1) + digit(2)) + 10 * digit(4) + digit(5);
  text = text.substr(0, text.size() - kZone) + "Z";
  return (zone[0] == '-' ? -60 : 60) * minutes;
}

std::optional<std::int64_t> time_of(const json& value) {
  if (const std::optional<double> number = number_of(value)) {
    const double s = *number >= kLeastMilliseconds ? 1e-3 * *number : *number;
    if (!(s > 0) || s > kMostTime_s) return std::nullopt;
    return std::llround(1e6 * s);
  }
  if (!value.is_string()) return std::nullopt;
  std::string text = value.get<std::string>();
  const std::int64_t zone_s = take_zone_s(text);
  const std::optional<std::int64_t> time_us = read_utc(text);
  return time_us ? std::optional(*time_us - kSecond_us * zone_s) : std::nullopt;
}

/// Returns the part of a document at a JSON pointer; null if the document lacks it.
const json* part_of(const json& document, const std::string& pointer) {
  const json::json_pointer at(pointer);
  return document.contains(at) ? &document.at(at) : nullptr;
}

}  // namespace

std::optional<MqttReading> read_mqtt_payload(const std::string& payload,
                                             const WeatherSettings& covariate,
                                             std::string& problem) {
  if (covariate.field.empty()) {
    const std::optional<double> value = finite_number(payload);
    if (!value) problem = shown(payload) + " is not a number";
    return value ? std::optional(MqttReading{*value}) : std::nullopt;
  }
  const json document = json::parse(payload, nullptr, false);
  if (document.is_discarded()) {
    problem = shown(payload) + " is not JSON";
    return std::nullopt;
  }
  const json* const at = part_of(document, covariate.field);
  const std::optional<double> value = at == nullptr ? std::nullopt : number_of(*at);
  if (!value) {
    problem = fmt::format("{} has no number at {}", shown(payload), covariate.field);
    return std::nullopt;
  }
  MqttReading out{*value};
  if (covariate.time_field.empty()) return out;
  const json* const time = part_of(document, covariate.time_field);
  if (time != nullptr) out.time_us = time_of(*time);
  if (out.time_us) return out;
  problem = fmt::format("{} has no time at {}, such as 2026-01-31T12:00:00Z", shown(payload),
                        covariate.time_field);
  return std::nullopt;
}

}  // namespace framewatch::daemon
