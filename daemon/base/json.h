// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <iterator>
#include <string>

#include <fmt/core.h>
#include <fmt/format.h>
#include <nlohmann/json_fwd.hpp>

namespace framewatch::daemon {

/// Returns a number as JSON text with 9 digits, or "null" if it is not finite.
std::string json_number(double value);
/// Returns a JSON string with quotes and escapes. Replaces bytes that are not UTF-8.
std::string json_text(const std::string& text);

using Json = nlohmann::ordered_json;

/// Larger values can round to infinity.
constexpr double kMaxInJson = 1e300;

/// Returns "[1.25,null,3]". Values beyond +-kMaxInJson and NaN become null. `format`: fmt format of
/// each value.
template <typename Values>
std::string json_list(const Values& values, const char* format = "{}") {
  std::string out;
  for (const auto value : values) {
    if (!out.empty()) out += ',';
    if (std::abs(static_cast<double>(value)) <= kMaxInJson)
      fmt::format_to(std::back_inserter(out), fmt::runtime(format), value);
    else
      out += "null";
  }
  return "[" + out + "]";
}

/// Returns the number, or null if it is not finite.
Json json_value(double value);

/// Returns the number as JSON text with all significant digits, or "null".
std::string json_value_text(double value);

/// Returns `json` as one line. Replaces bytes that are not UTF-8.
std::string json_line(const Json& json);

}  // namespace framewatch::daemon
