#include "daemon/keys/options_markdown.h"

#include <algorithm>
#include <vector>

#include <fmt/core.h>

#include "daemon/keys/option_table.h"
#include "daemon/keys/section_table.h"

namespace framewatch::daemon {
namespace {

/// | would end the cell.
std::string cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2))
    text.insert(at, 1, '\\');  // one character: g++ 12 warns wrongly of the other overload
  return text;
}

std::string default_of(const Option& o) {
  if (o.required) return "required";
  if (o.default_value.empty()) return "";
  if (o.paper_default.empty()) return fmt::format("`{}`", o.default_value);
  return fmt::format("`{}`; `{}` in the paper's variant", o.default_value, o.paper_default);
}

std::string type_of(const Option& o) {
  switch (o.type) {
    case OptionType::text:
      return "text";
    case OptionType::choice:
      return "text";
    case OptionType::integer:
      return "whole number";
    case OptionType::number:
      return "number";
    case OptionType::boolean:
      return "true or false";
    case OptionType::texts:
      return "list of texts";
    case OptionType::grid:
      return fmt::format("number or {}", o.shape);
    case OptionType::table:
      return "table";
  }
  return "";
}

}  // namespace

std::string options_markdown() {
  std::string out =
      "# Configuration\n\n"
      "Made by `framewatch check --print-options-markdown` from the option table; do not edit.\n\n"
      "A configuration is one TOML file. `framewatch check FILE` lists every problem of it with "
      "line and column: unknown keys, keys given twice, wrong types, shapes and units, values out "
      "of range, channels that do not fit the building. Units are part of the keys' names.\n";
  for (const SectionDescription& s : section_table()) {
    out += fmt::format("\n## `{}`\n\n{}\n\n", s.heading, s.text);
    out +=
        "| key | type | unit | default | must be | meaning |\n| --- | --- | --- | --- | --- | --- "
        "|\n";
    for (const Option& o : options())
      if (o.section == s.section)
        out += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", o.key, type_of(o), o.unit,
                           default_of(o), cell(constraint(o)), cell(std::string(o.meaning)));
  }
  return out;
}

}  // namespace framewatch::daemon
