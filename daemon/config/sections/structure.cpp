// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/core.h>

#include "daemon/config/keys/section.h"
#include "daemon/config/sections/sections.h"
#include "estimator/structure/natural_frequencies.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

std::vector<double> frame_stiffness(ConfigSection& section, const char* key, int stories,
                                    int frames) {
  if (frames > 0 && !section.value(key))
    section.problem(key, "is missing: a design needs the stiffness of every frame");
  if (frames == 0 && section.given(key))
    section.problem(key, "the structure has no frame in this direction");
  return frames > 0 ? section.grid(key, {stories, frames}) : std::vector<double>{};
}

/// Returns a grid of damping values, or an empty list if the key is missing or has a problem.
std::vector<double> damping(ConfigSection& section, const char* key,
                            const std::vector<int>& sizes) {
  if (!section.given(key)) return {};
  for (const int size : sizes)
    if (size < 1) {
      section.problem(key, "the structure has nothing of this kind");
      return {};
    }
  return section.grid(key, sizes);
}

/// Returns the mean stiffness of the frames of one story.
double mean_frame_stiffness(const Eigen::VectorXd& theta, const estimator::ParameterTable& table,
                            const estimator::Structure& s, int story) {
  double sum = 0;
  for (int f = 0; f < s.frames(); ++f) sum += theta[table.frame_stiffness(story, f)];
  return sum / s.frames();
}

DesignReading read_design(const TomlValue* design, const estimator::Structure& s, bool shape_known,
                          std::vector<TextProblem>& problems) {
  if (!design) return {};
  ConfigSection section("structure.design", "structure.design", design, {}, problems);
  if (!shape_known) return {};
  const std::vector<double> kx = frame_stiffness(section, "kx_npm", s.stories, s.n());
  const std::vector<double> ky = frame_stiffness(section, "ky_npm", s.stories, s.m());
  const bool has_panels = s.n() > 1 && s.m() > 1;
  if (section.given("gk") && !has_panels)
    section.problem("gk", "a plane building or a single frame has no floor panel");
  std::vector<double> gk;
  if (section.given("gk")) gk = section.grid("gk", {s.stories, s.n() - 1, s.m() - 1});
  const std::vector<double> cx = damping(section, "cx_nspm", {s.stories, s.n()});
  const std::vector<double> cy = damping(section, "cy_nspm", {s.stories, s.m()});
  const std::vector<double> gc = damping(section, "gc", {s.stories, s.n() - 1, s.m() - 1});
  DesignReading out;
  for (const auto& [key, frames, which] :
       {std::tuple("krx_nmprad", s.n(), 0), std::tuple("kry_nmprad", s.m(), 1)}) {
    if (!section.given(key)) continue;
    if (frames == 0) section.problem(key, "the structure has no frame in this direction");
    const std::vector<double> of_floors = section.grid(key, {s.stories});
    if (!section.good(key)) continue;
    const auto along = static_cast<std::size_t>(which);
    out.bending_nmprad.base_nmprad[along] = of_floors[0];
    for (const double value : of_floors)
      out.bending_nmprad.shares[along].push_back(value / of_floors[0]);
  }
  if (!find_problems(s).empty() || !section.good()) return {};

  const estimator::ParameterTable table(s);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  for (int story = 1; story <= s.stories; ++story) {
    for (int f = 0; f < s.frames(); ++f) {
      const int in_story = f < s.n() ? f : f - s.n();
      const int row = (story - 1) * (f < s.n() ? s.n() : s.m());
      theta[table.frame_stiffness(story, f)] =
          (f < s.n() ? kx : ky)[static_cast<std::size_t>(row + in_story)];
    }
    for (int p = 0; p < s.panels(); ++p)
      theta[table.panel_stiffness(story, p)] =
          gk.empty() ? mean_frame_stiffness(theta, table, s, story)
                     : gk[static_cast<std::size_t>((story - 1) * s.panels() + p)];
  }
  theta = with_proportional_damping(s, table, theta, section.number("damping_ratio"));
  for (int story = 1; story <= s.stories; ++story) {
    const auto at = [&](int row, int column) { return static_cast<std::size_t>(row + column); };
    for (int f = 0; f < s.n() && !cx.empty(); ++f)
      theta[table.frame_damping(story, f)] = cx[at((story - 1) * s.n(), f)];
    for (int f = 0; f < s.m() && !cy.empty(); ++f)
      theta[table.frame_damping(story, s.n() + f)] = cy[at((story - 1) * s.m(), f)];
    for (int p = 0; p < s.panels() && !gc.empty(); ++p)
      theta[table.panel_damping(story, p)] = gc[at((story - 1) * s.panels(), p)];
  }
  out.theta = theta;
  return out;
}

constexpr std::size_t kMaxFrames = 100;

/// Checks names of frames, which become CSV columns and parts of parameter names.
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
  ConfigSection section("structure", document, problems);
  check_names(section, "frames_x");
  check_names(section, "frames_y");
  check_names(section, "labels_x");
  check_names(section, "labels_y");
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
    const bool depends_on_shape = p.field == "node_mass_kg" || p.field == "story_height_m" ||
                                  p.field.starts_with("span_") || p.field.starts_with("labels_");
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
  out.design = read_design(section.value("design"), s, shape_known, problems);
  return out;
}

}  // namespace framewatch::daemon
