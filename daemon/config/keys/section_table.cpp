// SPDX-License-Identifier: MIT
#include "daemon/config/keys/section_table.h"

#include <cmath>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

constexpr const char* kIntroduction =
    "# Configuration\n\n"
    "Made by `framewatch check --print-options-markdown` from the option table; do not edit.\n\n"
    "A configuration is one TOML file. `framewatch check FILE` lists every problem with line and "
    "column. Units are part of the keys' names. Ranges include their ends, except after \"above\"."
    "\n\n"
    "`framewatch init` writes a first configuration. It asks for stories, bays, spans, heights and "
    "masses, and takes the channels from a record's header, from LCM or from a DBC file. With 0x0 "
    "bays, one frame stands for all frames of a direction: one accelerometer per floor and "
    "direction is enough.\n\n"
    "`check`, `run` and `replay` warn of unusual values: stories outside 0.02 to 20 m, spans "
    "outside 0.05 to 100 m, floors outside 20 to 3000 kg/m^2 (1 to 8000 in models, whose stories "
    "are below 2 m), a first natural frequency more than 10 times from 46 Hz m over the height "
    "(models: outside 0.2 to 100 Hz), its damping ratio outside 0.001 to 0.3, and a story over 100 "
    "times as stiff as another.\n";

std::string type_of(const Option& o) {
  switch (o.type) {
    case OptionType::text:
      return "text";
    case OptionType::choice:
      return constraint(o);
    case OptionType::integer:
      return "integer";
    case OptionType::number:
      return "number";
    case OptionType::boolean:
      return "boolean";
    case OptionType::texts:
      return "list of texts";
    case OptionType::grid:
      return fmt::format("number or {}", o.shape);
    case OptionType::table:
      return "table";
  }
  return "";
}

/// Returns "0 to 3600", "above 0" or "at least 1". Empty if all values are allowed.
std::string range_of(const Option& o) {
  if (!std::isfinite(o.range.min)) return "";
  if (!std::isfinite(o.range.max))
    return fmt::format("{} {:.10g}", o.range.above_min ? "above" : "at least", o.range.min);
  return fmt::format("{}{:.10g} to {:.10g}", o.range.above_min ? "above " : "", o.range.min,
                     o.range.max);
}

/// Returns "above 0 to 3600 s, default `5`". A range replaces the word "number". docs/effects.md
/// has the units of effects.
std::string value_of(const Option& o) {
  const std::string range = range_of(o);
  std::string out = range.empty() || o.type != OptionType::number ? type_of(o) : "";
  if (o.type == OptionType::grid && !range.empty()) out += ",";
  if (!range.empty()) out += (out.empty() ? "" : " ") + range;
  if (!o.unit.empty() && o.section != "effect") out += fmt::format(" {}", o.unit);
  if (o.required) out += ", required";
  if (!o.default_value.empty()) out += fmt::format(", default `{}`", o.default_value);
  if (!o.paper_default.empty()) out += fmt::format(" (variant paper: `{}`)", o.paper_default);
  return out;
}

bool share_a_line(const Option& a, const Option& b) {
  return a.meaning == b.meaning && value_of(a) == value_of(b);
}

/// Returns one line per option. Options that differ only in their keys share a line.
std::string lines_of(std::string_view section) {
  std::string out;
  std::string keys;
  const Option* last = nullptr;
  const auto write = [&] {
    if (last) out += fmt::format("- {} ({}): {}\n", keys, value_of(*last), last->meaning);
    keys.clear();
  };
  for (const Option& o : options()) {
    if (o.section != section) continue;
    // A sensor has the keys of all sensors.
    if (section == "sensor" && find_option("sensors", o.key)) continue;
    if (last && !share_a_line(*last, o)) write();
    keys += fmt::format("{}`{}`", keys.empty() ? "" : ", ", o.key);
    last = &o;
  }
  write();
  return out;
}

const SectionDescription kSections[] = {
    {"structure", "[structure]",
     "The building. Frames are numbered x-parallel first (by y), then y-parallel (by x). One "
     "number stands for a list of equal values.",
     Reach::restart},
    {"structure.design", "[structure.design]",
     "Optional values from the drawings. They tune the filters before the first estimates and "
     "define the prior.",
     Reach::restart},
    {"channel", "[[channel]]",
     "One accelerometer axis. Each frame needs one on every floor, and the base needs one per "
     "direction with frames. The corrected value is polarity * (scale * raw - offset).",
     Reach::restart},
    {"channel.source", "source = { lcm ... }", "Samples from LCM.", Reach::restart},
    {"channel.source.can", "source = { can ... }", "Samples from CAN ([setup](can.md)).",
     Reach::restart},
    {"estimator", "[estimator]", "How windows are estimated and published.", Reach::restart},
    {"lcm", "[lcm]", "The LCM bus for samples and estimates.", Reach::restart},
    {"commands", "[commands]",
     "Where a daemon takes commands ([permissions](operate.md#who-may-give-commands)).",
     Reach::restart},
    {"can", "[[can]]", "One CAN bus.", Reach::restart},
    {"can_node", "[[can_node]]", "One sender of samples on a CAN bus, and its timing.",
     Reach::restart},
    {"weather", "[[weather]]",
     "Optional: weather and use that may change the building, up to 20 of them "
     "([years](years.md)). The value is scale * raw - offset. The thermometer of [watch] counts as "
     "`temperature_degc` without a table.",
     Reach::restart},
    {"weather.source", "source = { lcm, thermometer, can or mqtt ... }",
     "Where the readings of a covariate come from.", Reach::restart},
    {"mqtt", "[mqtt]",
     "Optional: the MQTT broker of covariates with a topic ([MQTT](years.md#mqtt)). framewatch "
     "subscribes to these topics and publishes nothing.",
     Reach::restart},
    {"watch", "[watch]", "Optional: detect lasting stiffness changes and publish them as events.",
     Reach::settings},
    {"gap", "[gap]",
     "Optional: simulate the building and compare with its measurement ([the gap](gap.md)).",
     Reach::settings},
    {"history", "[history]",
     "Optional: `framewatch run` keeps raw samples, summaries and events on disk "
     "([history](history.md)).",
     Reach::restart},
    {"event_report", "[event_report]",
     "Optional: write a page and a JSON file after every strong motion ([after an "
     "earthquake](operate.md#after-an-earthquake)).",
     Reach::restart},
    {"fragility", "[fragility]",
     "Optional: drifts that damage stories, for the placard after strong motion "
     "([how](operate.md#drift-damage-and-placard)). Without this section, damage is not judged.",
     Reach::restart},
    {"actions", "[actions]",
     "Optional: `framewatch run` notifies people of events by a command, a webhook and e-mail "
     "([actions](actions.md)).",
     Reach::settings},
    {"email", "[email]",
     "Optional: the mail server and the account that send e-mail ([e-mail](actions.md#e-mail)).",
     Reach::settings},
    {"report", "[report]",
     "Optional: `framewatch run` writes a report every month ([monthly "
     "report](years.md#a-report-every-month)).",
     Reach::settings},
    {"fleet", "[fleet]",
     "Optional: `framewatch uplink` sends the history to a hub of many buildings "
     "([fleet](fleet.md)). Needs [history]; `framewatch run` ignores this section.",
     Reach::settings},
    {"scenario", "Scenario files: at the top",
     "Input of `framewatch simulate`: the building and what happens to it."},
    {"truth", "[truth]",
     "The true values of the simulated building, unknown to the estimator. Defaults come from the "
     "design."},
    {"motion", "[motion]", "The ground motion."},
    {"sensors", "[sensors]", "Errors of every simulated accelerometer."},
    {"sensor", "[[sensor]]", "Different errors of one channel. All keys of [sensors] apply."},
    {"change", "[[change]]", "A parameter change during the simulation."},
    {"climate", "[climate]",
     "Optional: weather and use, which change stiffness and damping by the hour "
     "([years](years.md#simulate-years))."},
    {"effect", "[[effect]]",
     "An effect beyond the linear building, in a scenario or a configuration. "
     "[Effects](effects.md) lists equations and the keys of each kind.",
     Reach::restart},
    {"expect", "Expectation files: at the top",
     "Input of `framewatch replay --expect`; `--write-expect` creates one ([replay in "
     "CI](replay-in-ci.md))."},
    {"expect.counts", "[counts]", "Expected counts."},
    {"expect.parameter", "[[parameter]]", "Expected values of a parameter or group."},
    {"expect.event", "[[event]]", "Expected events."},
    {"about", "Report files: at the top",
     "Input of `framewatch report --about` and `compare --about`: the head of a report for a "
     "client."},
    {"about.photograph", "[[photograph]]", "A photograph in the report."},
    {"baseline.parameter", "Baseline files: [[parameter]]", "Reference values of [watch]."},
};

}  // namespace

std::string options_markdown() {
  std::string out = kIntroduction;
  for (const SectionDescription& s : section_table())
    out += fmt::format("\n## `{}`\n\n{}\n\n{}", s.heading, s.text, lines_of(s.section));
  return out;
}

std::span<const SectionDescription> section_table() {
  return kSections;
}

const SectionDescription* find_section(std::string_view section) {
  for (const SectionDescription& s : kSections)
    if (s.section == section) return &s;
  return nullptr;
}

}  // namespace framewatch::daemon
