// SPDX-License-Identifier: MIT
#include "daemon/tools/commands/check_command.h"

#include <array>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/base/printable.h"
#include "daemon/config/keys/section_table.h"
#include "daemon/config/read_config.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/tools/commands/check_report.h"
#include "daemon/tools/simulation/scenario.h"
#include "estimator/structure/effect.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kIntroduction = R"(# Effects

Made by `framewatch check --print-effects-markdown` from the catalogue of effects; do not edit.

Effects are what a linear shear building with perfect accelerometers leaves out. Write one
`[[effect]]` table for each; parameters without a default are required:

```toml
[[effect]]
kind = "cubic_stiffness"
story = 1
frame = "y1"
k3_npm3 = 1e7
```

d is the deformation in m (b'y of [the equations](equations.md)) and v its rate. For a frame story,
d is the story drift, positive when the upper floor is further toward +x or +y. For a floor panel, d
is the shear angle times sqrt(Lx Ly). f is a restoring force in N, added to k d + c v.

Keys for each place:

- frame story: `story`, `frame`
- floor panel: `story`, `panel` (the frames where its spans start, such as `"x1y1"`)
- node: `story`, `frame` (one degree of freedom)
- two floors: `story`, `to_story` (0: base), `frame`
- crossing: `story`, `node` (such as `"x1y1"`, both directions)
- floor: `story`
- building: `direction`
- whole frame: `frame`
- mode: `mode` (1: lowest natural frequency)
- channel: `channel`
- two channels: `channel`, `with_channel`

`framewatch simulate` advances the linear part with the matrix exponential, and the laws with a
fourth-order Runge-Kutta scheme (Lawson, SIAM J. Numer. Anal. 4, 1967) in steps of at most 0.5 ms.
Halving the steps changes no response in `tests/simulate` by more than 3e-5 of its peak. Channel
effects act before the sensor's noise, clipping after it.
)";

/// Words for estimator::PlaceKind, in its order.
constexpr std::array kPlaces = {"frame story", "floor panel", "node",        "two floors",
                                "crossing",    "floor",       "building",    "whole frame",
                                "mode",        "channel",     "two channels"};
static_assert(kPlaces.size() == static_cast<std::size_t>(estimator::PlaceKind::channel_pair) + 1);

/// Returns " (N/m, default `0`)". Empty without unit and default.
std::string value_of(const estimator::EffectParameter& p) {
  std::string out(p.unit);
  if (p.default_value)
    out += fmt::format("{}default `{}`", out.empty() ? "" : ", ", *p.default_value);
  return out.empty() ? "" : fmt::format(" ({})", out);
}

/// Returns docs/effects.md, made from the catalog of effects.
std::string effects_markdown() {
  std::string out = kIntroduction;
  for (const estimator::EffectDescription& d : estimator::effect_catalogue()) {
    std::string places;
    for (const estimator::PlaceKind place : d.places)
      places += fmt::format("{}{}", places.empty() ? "" : " or ",
                            kPlaces[static_cast<std::size_t>(place)]);
    out += fmt::format("\n## `{}`\n\nAt: {}.\n\n```\n{}\n```\n\n", d.name, places, d.equation);
    if (!d.sign.empty()) out += fmt::format("{} ", d.sign);
    out += fmt::format("Source: {}.\n", d.source);
    if (d.parameters.empty()) continue;
    out += "\n";
    for (const estimator::EffectParameter& p : d.parameters)
      out += fmt::format("- `{}`{}: {}\n", p.key, value_of(p), p.meaning);
  }
  return out;
}

/// Returns true if the file is a scenario. Unreadable files count as configurations, so their
/// problems are reported.
bool names_scenario(const std::string& path) {
  std::string error;
  std::vector<TextProblem> ignored;
  const std::optional<std::string> text = read_text_file(path, error);
  const std::optional<TomlValue> document = text ? parse_toml(*text, ignored) : std::nullopt;
  return document && is_scenario(*document);
}

}  // namespace

int check_command(const CheckArguments& arguments) {
  if (arguments.print_options_markdown) {
    fmt::print("{}", options_markdown());
    return 0;
  }
  if (arguments.print_effects_markdown) {
    fmt::print("{}", effects_markdown());
    return 0;
  }
  std::vector<ConfigProblem> problems;
  const bool scenario = names_scenario(arguments.config);
  std::optional<Config> config;
  if (!scenario)
    config = load_config(arguments.config, problems);
  else if (auto read = load_scenario(arguments.config, problems))
    config = std::move(read->config);
  std::optional<CheckReport> report;
  if (config) report = make_check_report(*config, arguments.advise);
  if (arguments.json) {
    fmt::print("{}", to_json(arguments.config, report, problems));
  } else if (report) {
    if (scenario)
      fmt::print("{}: a scenario for framewatch simulate, good; its building:\n",
                 printable(arguments.config));
    fmt::print("{}", printable_lines(to_text(*report)));
    const std::string label = toned(Tone::doubtful, "warning:", stdout);
    for (const std::string& warning : report->warnings)
      fmt::print("{} {}\n", label, printable_lines(warning));
  } else {
    print_problems(problems);
    fmt::print(stderr, "{}: {}{} problem{}\n", arguments.config, scenario ? "a scenario, " : "",
               problems.size(), problems.size() == 1 ? "" : "s");
  }
  return report ? 0 : 2;
}

}  // namespace framewatch::daemon
