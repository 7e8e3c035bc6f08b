#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/config/keys/section.h"
#include "daemon/config/sections/sections.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxFrames = 100;

/// Names become columns of CSV files and parts of parameter names.
void check_names(ConfigSection& section, const char* key) {
  for (const std::string& name : section.texts(key))
    if (const std::string rule = problem_of_name(name); !rule.empty()) section.problem(key, rule);
  if (section.texts(key).size() > kMaxFrames)
    section.problem(key, fmt::format("at most {} frames", kMaxFrames));
}

}  // namespace

std::string problem_of_name(const std::string& name) {
  if (name.empty()) return "a name must not be empty";
  if (name.front() == ' ' || name.back() == ' ')
    return fmt::format("\"{}\": a name must not begin or end with a space", name);
  for (const char c : name)
    if (c == ',' || c == '"' || static_cast<unsigned char>(c) < ' ')
      return fmt::format("\"{}\": a name must not hold a comma, a quote or a control character",
                         name);
  return "";
}

StructureReading read_structure(const TomlValue& document, std::vector<TextProblem>& problems) {
  const TomlEntry* entry = document.find("structure");
  ConfigSection section("structure", "structure", entry ? &entry->value : nullptr, {1, 1},
                        problems);
  check_names(section, "frames_x");
  check_names(section, "frames_y");
  StructureReading out;
  estimator::Structure& s = out.structure;
  section.read_into(s);
  out.stories_known = section.good("stories");
  out.frames_known = section.good("frames_x") && section.good("frames_y");
  const bool shape_known = out.stories_known && out.frames_known;
  if (out.frames_known) {
    s.span_x = section.grid("span_x_m", {std::max(s.m() - 1, 0)});
    s.span_y = section.grid("span_y_m", {std::max(s.n() - 1, 0)});
  }
  if (out.stories_known) s.story_height = section.grid("story_height_m", {s.stories});
  if (shape_known && s.frames() > 0)
    s.node_mass = section.grid("node_mass_kg", {s.stories, std::max(s.n(), 1), std::max(s.m(), 1)});
  for (const estimator::Problem& p : find_problems(s)) {
    const bool depends_on_shape =
        p.field == "node_mass_kg" || p.field == "story_height_m" || p.field.starts_with("span_");
    if ((depends_on_shape && !shape_known) || (p.field == "node_mass_kg" && s.frames() == 0))
      continue;
    if (p.field.empty() ? out.frames_known : section.good(p.field)) {
      section.problem(p.field, p.field.empty() ? p.message : p.message.substr(p.field.size() + 2));
      if (p.field.empty() || p.field.starts_with("frames")) out.frames_known = false;
    }
  }
  for (const double floor : section.list("group_floors")) {
    if (floor != std::floor(floor)) section.problem("group_floors", "floors are whole numbers");
    out.group_floors.push_back(static_cast<int>(floor));
  }
  out.mass_tolerance = section.number("mass_tolerance_ratio");
  out.profile_tolerance = section.number("profile_tolerance_ratio");
  if (section.given("azimuth_y_deg")) out.azimuth_y_deg = section.number("azimuth_y_deg");
  const TomlEntry* design = entry ? entry->value.find("design") : nullptr;
  out.design = read_design(design ? &design->value : nullptr, s, shape_known, problems);
  return out;
}

}  // namespace framewatch::daemon
