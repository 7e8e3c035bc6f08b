#pragma once

#include <cmath>
#include <iterator>
#include <string>

#include <fmt/core.h>
#include <fmt/format.h>
#include <nlohmann/json_fwd.hpp>

namespace framewatch::daemon {

using Json = nlohmann::ordered_json;

/// "[1.25,null,3]": values that are not finite are null. format: of each value.
template <typename Values>
std::string json_list(const Values& values, const char* format = "{}") {
  std::string out;
  for (const auto value : values) {
    if (!out.empty()) out += ',';
    if (std::isfinite(static_cast<double>(value)))
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
