#include <algorithm>
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

/// A grid of damping that may be missing.
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

/// Of the frames of one story.
double mean_frame_stiffness(const Eigen::VectorXd& theta, const estimator::ParameterTable& table,
                            const estimator::Structure& s, int story) {
  double sum = 0;
  for (int f = 0; f < s.frames(); ++f) sum += theta[table.frame_stiffness(story, f)];
  return sum / s.frames();
}

}  // namespace

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
  const bool complete = find_problems(s).empty() && section.good("kx_npm") &&
                        section.good("ky_npm") && section.good("gk") &&
                        section.good("damping_ratio") && section.good("cx_nspm") &&
                        section.good("cy_nspm") && section.good("gc") &&
                        section.good("krx_nmprad") && section.good("kry_nmprad");
  if (!complete) return {};

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

}  // namespace framewatch::daemon
