#pragma once

#include <cmath>
#include <iterator>
#include <string>

#include <fmt/core.h>
#include <fmt/format.h>
#include <nlohmann/json_fwd.hpp>

namespace framewatch::daemon {

/// A number as JSON writes it, with 9 digits; null when it is not finite.
std::string json_number(double value);
/// A string as JSON writes it, with quotes and escapes; bytes that are no UTF-8 are replaced.
std::string json_text(const std::string& text);

using Json = nlohmann::ordered_json;

/// What is larger can be infinite once it is rounded.
constexpr double kMaxInJson = 1e300;

/// "[1.25,null,3]": values beyond +-kMaxInJson and those that are no numbers are null. format: of
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

/// A number, or null when it is not finite.
Json json_value(double value);

/// The same as text, with all digits that matter.
std::string json_value_text(double value);

/// One line; bytes that are not UTF-8 are replaced.
std::string json_line(const Json& json);

}  // namespace framewatch::daemon
