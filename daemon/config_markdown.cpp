#include "daemon/config_markdown.h"

#include <algorithm>
#include <vector>

#include <fmt/core.h>

#include "daemon/config_options.h"

namespace framewatch::daemon {
namespace {

struct SectionText {
  std::string_view section;
  std::string_view heading;
  std::string_view text;
};

constexpr SectionText kSections[] = {
    {"structure", "[structure]",
     "The building. Frames at a floor are numbered x-parallel first, in order of y, then "
     "y-parallel, in order of x. A number stands for a list of equal values."},
    {"structure.design", "[structure.design]",
     "Optional: what the drawings say, never taken for truth. It tunes the filters before the "
     "first estimates and is what the prior pulls toward."},
    {"channel", "[[channel]]",
     "One accelerometer axis each. Every frame has one on every floor, and the base one in every "
     "direction that has frames. The corrected value is polarity * (scale * raw - offset)."},
    {"channel.source", "source = { lcm ... }", "Samples that come over LCM."},
    {"channel.source.can", "source = { can ... }",
     "Samples that come over CAN ([how to commission a bus](can.md))."},
    {"estimator", "[estimator]", "How the windows are estimated and when a value is published."},
    {"lcm", "[lcm]", "The bus the samples come from and the estimates go to."},
    {"can", "[[can]]", "One CAN bus each, and what it carries."},
    {"can_node", "[[can_node]]",
     "One sender of samples on a CAN bus each, and how its samples get their time."},
    {"watch", "[watch]",
     "Optional: stiffness is watched for lasting changes, and event_t messages say which element, "
     "how much, how sure and since when."},
    {"gap", "[gap]",
     "Optional: the building is simulated beside its measurement, and what differs is told "
     "([the gap](gap.md))."},
    {"history", "[history]",
     "Optional: `framewatch run` keeps raw samples, summaries and events on disk "
     "([history](history.md))."},
    {"actions", "[actions]",
     "Optional: `framewatch run` tells people of events, by a command and a webhook "
     "([telling people](actions.md))."},
    {"scenario", "Scenario files: at the top",
     "`framewatch simulate` reads a scenario: the building as above or `config`, and what happens "
     "to it."},
    {"truth", "[truth]", "What the virtual building is, which the estimator does not know."},
    {"motion", "[motion]", "What the ground does."},
    {"sensors", "[sensors]", "What every virtual accelerometer is like."},
    {"sensor", "[[sensor]]", "One that is different."},
    {"change", "[[change]]", "Something in the building that changes while it is shaken."},
    {"effect", "[[effect]]",
     "What the linear building leaves out, in a scenario or a configuration, once for each: kind, "
     "place and numbers; [effects](effects.md) has the equations, and which keys belong to which "
     "kind."},
    {"expect", "Expectation files: at the top",
     "`framewatch replay --expect` holds a replay to such a file, `--write-expect` makes a first "
     "one "
     "([replay in CI](replay-in-ci.md))."},
    {"expect.counts", "[counts]", "What became of the input."},
    {"expect.parameter", "[[parameter]]", "What the windows of a parameter, or of a group, say."},
    {"expect.event", "[[event]]", "Alarms, by the time since when they hold."},
    {"baseline.parameter", "Baseline files: [[parameter]]", "Reference parameters of [watch]."},
};

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
  for (const SectionText& s : kSections) {
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
