// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <fmt/core.h>

#include "daemon/config/keys/option_table.h"

namespace framewatch::test {

/// Returns a value for the key that is not its default, as TOML text.
inline std::string another_value(const daemon::Option& o) {
  using daemon::OptionType;
  switch (o.type) {
    case OptionType::text:
      return "\"another\"";
    case OptionType::texts:
      return "[\"another\"]";
    case OptionType::boolean:
      return o.default_value == "true" ? "false" : "true";
    case OptionType::choice: {
      // Not the first choice, because an unset field often has that value.
      const std::vector<std::string> all = daemon::choices(o);
      const std::string last = "\"" + all.back() + "\"";
      return last == o.default_value ? "\"" + all[all.size() - 2] + "\"" : last;
    }
    case OptionType::integer:
    case OptionType::number:
    case OptionType::grid: {
      const double low = o.range.min > -1e12 ? o.range.min : -1;
      const double high = o.range.max < 1e12 ? o.range.max : 1e6;
      // A fortieth of the range, where few defaults are.
      const double value = low + (high - low) / 40;
      std::string text = o.type == OptionType::integer
                             ? fmt::format("{}", static_cast<long>(value) + 1)
                             : fmt::format("{:.6g}", value);
      if (text == o.default_value) text = fmt::format("{:.6g}", low);
      return o.type == OptionType::grid ? "[" + text + "]" : text;
    }
    case OptionType::table:
      break;
  }
  return "{}";
}

}  // namespace framewatch::test
