// SPDX-License-Identifier: MIT
#include "daemon/base/json.h"

#include <string_view>

#include <nlohmann/json.hpp>

#include "daemon/base/printable.h"

namespace framewatch::daemon {

std::string json_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.9g}", value) : "null";
}

std::string json_text(const std::string& text) {
  std::string out = "\"";
  for (std::string_view rest = text; !rest.empty();) {
    const CodePoint c = first_character(rest);
    const std::size_t bytes = c.bytes == 0 ? 1 : c.bytes;
    if (c.bytes == 0)
      out += "\\ufffd";
    else if (c.value == '"' || c.value == '\\')
      out += {'\\', rest.front()};
    else if (c.value < 0x20 || (c.value >= 0x7f && c.value < 0xa0))
      out += fmt::format("\\u{:04x}", c.value);
    else
      out += rest.substr(0, bytes);
    rest.remove_prefix(bytes);
  }
  return out + '"';
}

Json json_value(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string json_value_text(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "null";
}

std::string json_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace framewatch::daemon
