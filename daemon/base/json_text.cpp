#include "daemon/base/json_text.h"

#include <cmath>
#include <string_view>

#include <fmt/core.h>

#include "daemon/base/utf8.h"

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

}  // namespace framewatch::daemon
