// SPDX-License-Identifier: MIT
#include "daemon/config/read_config.h"

#include <algorithm>
#include <string>

#include <fmt/core.h>

#include "daemon/config/config_size.h"
#include "daemon/config/keys/section_table.h"
#include "daemon/config/keys/suggest.h"
#include "daemon/config/sections/effects.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {
namespace {

void check_sections(const TomlValue& document, std::vector<TextProblem>& problems) {
  std::vector<std::string> known;
  std::string headings;
  for (const SectionDescription& s : section_table()) {
    if (!s.reload) continue;  // a section of other files
    if (s.section.find('.') == std::string_view::npos) known.emplace_back(s.section);
    if (s.heading.starts_with('['))
      headings += (headings.empty() ? "" : ", ") + std::string(s.heading);
  }
  for (const TomlEntry& entry : document.entries) {
    if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    const std::string meant = nearest(entry.key, known);
    problems.push_back(
        {entry.place, fmt::format("unknown section or key {}: {}", entry.key,
                                  meant.empty() ? "the sections are " + headings
                                                : fmt::format("did you mean {}?", meant))});
  }
}

}  // namespace

bool is_scenario(const TomlValue& document) {
  return document.find("motion") != nullptr || document.find("truth") != nullptr ||
         (document.find("config") != nullptr && document.find("structure") == nullptr);
}

bool read_config(const TomlValue& document, Config& config, std::vector<TextProblem>& problems) {
  const std::size_t before = problems.size();
  if (is_scenario(document)) {
    problems.push_back({document.entries.front().place,
                        "this is a scenario, for framewatch simulate and check: here a "
                        "configuration is wanted, such as the one that a scenario names by its "
                        "key config"});
    return false;
  }
  check_sections(document, problems);
  const StructureReading structure = read_structure(document, problems);
  config.pipeline.structure = structure.structure;
  config.pipeline.design = structure.design.theta;
  config.pipeline.bending_nmprad = structure.design.bending_nmprad;
  config.pipeline.group_floors = structure.group_floors;
  config.pipeline.mass_tolerance = structure.mass_tolerance;
  config.pipeline.profile_tolerance = structure.profile_tolerance;
  config.azimuth_y_deg = structure.azimuth_y_deg;
  read_channels(document, structure, config, problems);
  config.pipeline.options = read_estimator(document, problems);
  config.lcm = read_lcm(document, problems);
  config.commands = read_commands(document, problems);
  config.weather = read_weather_tables(document, config, problems);
  read_can(document, config, problems);
  config.mqtt = read_mqtt(document, config, problems);
  config.watch = read_watch(document, problems);
  add_thermometer(config);
  if (config.watch) config.pipeline.options.long_window_s = config.watch->options.quiet_window_s;
  config.gap = read_gap(document, problems);
  config.history = read_history(document, problems);
  config.event_report = read_event_report(document, problems);
  config.fragility =
      read_fragility(document, structure.stories_known ? structure.structure.stories : 0, problems);
  read_notifications(document, config, problems);
  config.fleet = read_fleet(document, config.history.has_value(), problems);
  if (problems.size() == before)
    for (const std::string& rule : estimator::problems(config.pipeline))
      problems.push_back({{}, rule});
  if (problems.size() == before) check_size(document, config, problems);
  const bool sound = problems.size() == before;
  const std::vector<const TomlValue*> effects = tables_of(document, "effect", problems);
  if (sound)
    config.effects = read_effects(effects, structure.structure, config.pipeline.axes, problems);
  return problems.size() == before;
}

}  // namespace framewatch::daemon
