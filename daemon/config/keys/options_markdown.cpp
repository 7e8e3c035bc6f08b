#include "daemon/config/keys/options_markdown.h"

#include <algorithm>
#include <vector>

#include <fmt/core.h>

#include "daemon/config/keys/option_table.h"
#include "daemon/config/keys/section_table.h"

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
      "of range, channels that do not fit the building. Units are part of the keys' names.\n\n"
      "A first one is made by `framewatch init`: it asks for stories, bays, spans, heights and "
      "masses "
      "(or takes them as options, `framewatch init --help`), takes the channels from a record's "
      "header, from LCM or from a CAN bus' DBC file, and writes a file with comments. A column is "
      "put "
      "where its title says it in one way only; otherwise it is asked for. With the bays 0x0 one "
      "frame stands for all of its direction: one accelerometer a floor and direction is "
      "enough.\n\n"
      "`check`, `run` and `replay` warn of what hardly any building has, with the likely slip, and "
      "go "
      "on: stories outside 0.02 to 20 m, spans outside 0.05 to 100 m, floors outside 20 to 3000 "
      "kg/m^2 (1 to 8000 in stories below 2 m, which are models on tables), a first natural "
      "frequency "
      "further than 10 times from 46 Hz m over the height (of models: outside 0.2 to 100 Hz), its "
      "damping ratio outside 0.001 to 0.3, stories one of which is over 100 times as stiff as "
      "another.\n";
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
