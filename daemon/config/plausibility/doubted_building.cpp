#include "daemon/config/plausibility/doubted_building.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "daemon/config/plausibility/doubted_design.h"
#include "daemon/config/plausibility/plausible_limits.h"
#include "daemon/config/plausibility/value_place.h"

namespace framewatch::daemon {
namespace {

/// A length that may be in cm or mm where m is asked.
std::string slip_of_length(double value, PlausibleRange usual) {
  if (value > usual.most)
    for (const auto& [unit, per_m] : {std::pair("cm", 100.0), std::pair("mm", 1000.0)})
      if (usual.holds(value / per_m))
        return fmt::format("in {} where m is asked? Then it is {:g}", unit, value / per_m);
  return "in another unit than m?";
}

void doubt_lengths(const TomlValue& section, const char* key, const std::vector<double>& values,
                   PlausibleRange allowed, PlausibleRange usual, const char* what,
                   std::vector<TextProblem>& doubts) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (allowed.holds(values[i])) continue;
    doubts.push_back(
        {place_in(section, key, i, values.size()),
         fmt::format("structure.{}: {:g} m; {} are {:g} to {:g} m: {}", key, values[i], what,
                     allowed.least, allowed.most, slip_of_length(values[i], usual))});
    if (!is_list(section, key)) return;
  }
}

std::string slip_of_mass(double kg_per_m2, PlausibleRange allowed, std::size_t nodes) {
  if (kg_per_m2 < allowed.least && allowed.holds(1000 * kg_per_m2))
    return "mass in tonnes where kg is asked?";
  if (kg_per_m2 > allowed.most && nodes > 1 &&
      allowed.holds(kg_per_m2 / static_cast<double>(nodes)))
    return "the whole floor's mass given to each of its nodes?";
  return "mass in another unit than kg, or a span in another one than m?";
}

void doubt_masses(const TomlValue& section, const estimator::Structure& s,
                  std::vector<TextProblem>& doubts) {
  if (s.span_x.empty() || s.span_y.empty()) return;
  const double area_m2 = std::accumulate(s.span_x.begin(), s.span_x.end(), 0.0) *
                         std::accumulate(s.span_y.begin(), s.span_y.end(), 0.0);
  const auto stories = static_cast<std::size_t>(s.stories);
  const std::size_t nodes = s.node_mass.size() / stories;
  for (std::size_t i = 0; i < stories; ++i) {
    const auto begin = s.node_mass.begin() + static_cast<std::ptrdiff_t>(i * nodes);
    const double mass = std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(nodes), 0.0);
    const bool tall = s.story_height[i] >= kMinBuildingStory_m;
    const PlausibleRange allowed = tall ? kBuildingDensity : kModelDensity;
    if (allowed.holds(mass / area_m2)) continue;
    doubts.push_back(
        {place_in(section, "node_mass_kg", i, stories),
         fmt::format("structure.node_mass_kg: {:.4g} kg on the {:.4g} m^2 of floor {} are {:.3g} "
                     "kg/m^2; floors of {} have {:g} to {:g}: {}",
                     mass, area_m2, i + 1, mass / area_m2, tall ? "buildings" : "models",
                     allowed.least, allowed.most, slip_of_mass(mass / area_m2, allowed, nodes))});
    if (!is_list(section, "node_mass_kg")) return;
  }
}

}  // namespace

std::vector<TextProblem> doubted_values(const TomlValue& document, const estimator::Structure& s,
                                        const Eigen::VectorXd& design) {
  std::vector<TextProblem> doubts;
  const TomlEntry* structure = document.find("structure");
  if (!structure) return doubts;
  const TomlValue& section = structure->value;
  doubt_lengths(section, "span_x_m", s.span_x, kSpan_m, kUsualSpan_m, "spans", doubts);
  doubt_lengths(section, "span_y_m", s.span_y, kSpan_m, kUsualSpan_m, "spans", doubts);
  doubt_lengths(section, "story_height_m", s.story_height, kStoryHeight_m, kUsualStoryHeight_m,
                "stories, from a model's to a hall's,", doubts);
  doubt_masses(section, s, doubts);
  if (const TomlEntry* entry = section.find("design"); entry && design.size() > 0)
    doubt_design(entry->value, s, design, doubts);
  return doubts;
}

}  // namespace framewatch::daemon
