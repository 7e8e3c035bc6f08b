// SPDX-License-Identifier: MIT
#include "daemon/config/plausibility/doubted_building.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "daemon/config/plausibility/plausible_limits.h"
#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/quantile.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::daemon {
namespace {

/// Returns true if a section gives the key as a list instead of one number for all.
bool is_list(const TomlValue& section, std::string_view key) {
  const TomlEntry* entry = section.find(key);
  return entry && entry->value.kind == TomlKind::array;
}

/// Returns the place of item `index` of `count` of a grid: of the number for all if it is not a
/// list, or of the section if it lacks the key.
TextPlace place_in(const TomlValue& section, std::string_view key, std::size_t index,
                   std::size_t count) {
  const TomlEntry* entry = section.find(key);
  if (!entry) return section.place;
  const TomlValue* value = &entry->value;
  if (value->kind == TomlKind::array && value->items.size() == count) value = &value->items[index];
  while (value->kind == TomlKind::array && !value->items.empty()) value = &value->items.front();
  return value->place;
}

/// Dense matrices of larger buildings take too long.
constexpr int kMaxDegreesOfFreedom = 200;
/// Factor of a frequency for a thousandfold stiffness or mass.
constexpr double kThousandfold = 31.6;

/// Returns the probable unit error behind an implausible frequency.
std::string slip_of_frequency(double first_hz, PlausibleRange allowed) {
  if (allowed.holds(first_hz * kThousandfold)) return "stiffness in kN/m where N/m is asked?";
  if (allowed.holds(first_hz * kThousandfold * kThousandfold))
    return "stiffness in MN/m where N/m is asked?";
  if (allowed.holds(first_hz / kThousandfold)) return "mass in tonnes where kg is asked?";
  return "stiffness in another unit than N/m, or mass in another one than kg?";
}

const char* stiffness_key(const estimator::Structure& s) {
  return s.n() > 0 ? "kx_npm" : "ky_npm";
}

void doubt_frequency(const TomlValue& section, const estimator::Structure& s, double first_hz,
                     std::vector<TextProblem>& doubts) {
  const double height_m = std::accumulate(s.story_height.begin(), s.story_height.end(), 0.0);
  const bool tall = height_m >= kMinBuildingStory_m * s.stories;
  const double usual_hz = kFrequencyTimesHeight_mps / height_m;
  const PlausibleRange allowed =
      tall ? PlausibleRange{usual_hz / kMaxOffFrequency, usual_hz * kMaxOffFrequency}
           : kModelFrequency_hz;
  if (allowed.holds(first_hz)) return;
  const std::string usual =
      tall ? fmt::format("buildings of {:g} m have about {:.2g} Hz (46 / height)", height_m,
                         usual_hz)
           : fmt::format("models have {:g} to {:g} Hz", kModelFrequency_hz.least,
                         kModelFrequency_hz.most);
  doubts.push_back({place_in(section, stiffness_key(s), 0, static_cast<std::size_t>(s.stories)),
                    fmt::format("structure.design: with these stiffnesses and masses the first "
                                "natural frequency is {:.3g} Hz; {}: {}",
                                first_hz, usual, slip_of_frequency(first_hz, allowed))});
}

/// Returns the damping ratio of the mode that is lowest without damping. Returns nullopt for a
/// large building.
std::optional<double> first_damping_ratio(const estimator::Structure& s,
                                          const estimator::ParameterTable& table,
                                          const Eigen::VectorXd& design) {
  if (s.degrees_of_freedom() > kMaxDegreesOfFreedom) return std::nullopt;
  const estimator::Matrices matrices = assemble(s, table, design);
  const Eigen::MatrixXd r = floor_constraint(s);
  const estimator::RealEigen modes = estimator::generalized_eigen(
      r.transpose() * matrices.stiffness * r, r.transpose() * matrices.mass.asDiagonal() * r);
  if (!modes.good || !(modes.values[0] > 0)) return std::nullopt;
  const Eigen::VectorXd shape = r * modes.vectors.col(0);
  return shape.dot(matrices.damping * shape) / (2 * std::sqrt(modes.values[0]));
}

void doubt_damping(const TomlValue& section, double ratio, std::vector<TextProblem>& doubts) {
  if (kFirstDampingRatio.holds(ratio)) return;
  const bool by_ratio = !section.find("cx_nspm") && !section.find("cy_nspm");
  const char* key = by_ratio ? "damping_ratio" : section.find("cx_nspm") ? "cx_nspm" : "cy_nspm";
  doubts.push_back(
      {place_in(section, key, 0, 1),
       fmt::format("structure.design: the first mode's damping ratio is {:.3g}; "
                   "buildings have {:g} to {:g}: {}",
                   ratio, kFirstDampingRatio.least, kFirstDampingRatio.most,
                   by_ratio ? "0.02 stands for 2 %" : "damping in another unit than N*s/m?")});
}

/// Returns the stiffness of each story, summed over the frames of one direction.
void doubt_unequal_stories(const TomlValue& section, const char* key, const estimator::Structure& s,
                           int first_frame, int frames, const Eigen::VectorXd& design,
                           std::vector<TextProblem>& doubts) {
  if (frames == 0) return;
  const estimator::ParameterTable table(s);
  std::vector<double> stories(static_cast<std::size_t>(s.stories));
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < frames; ++f)
      stories[static_cast<std::size_t>(story - 1)] +=
          design[table.frame_stiffness(story, first_frame + f)];
  const auto [least, most] = std::minmax_element(stories.begin(), stories.end());
  if (!(*most > kMaxUnequalStories * *least)) return;
  std::vector<double> sorted = stories;
  const double usual = estimator::upper_median(sorted);
  const auto odd = *most / usual > usual / *least ? most : least;
  doubts.push_back(
      {place_in(section, key, static_cast<std::size_t>(odd - stories.begin()), stories.size()),
       fmt::format("structure.design.{}: story {} has {:.3g} N/m in all, story {} {:.3g} N/m; "
                   "stories of one building hardly differ by more than {:g} times: a power of ten "
                   "too many or too few?",
                   key, most - stories.begin() + 1, *most, least - stories.begin() + 1, *least,
                   kMaxUnequalStories)});
}

/// Appends warnings about [structure.design], whose table is `section`.
void doubt_design(const TomlValue& section, const estimator::Structure& s,
                  const Eigen::VectorXd& design, std::vector<TextProblem>& doubts) {
  const estimator::ParameterTable table(s);
  doubt_frequency(section, s, lowest_frequency_hz(s, table, design), doubts);
  if (const auto ratio = first_damping_ratio(s, table, design))
    doubt_damping(section, *ratio, doubts);
  doubt_unequal_stories(section, "kx_npm", s, 0, s.n(), design, doubts);
  doubt_unequal_stories(section, "ky_npm", s, s.n(), s.m(), design, doubts);
}

/// Returns the probable unit error of a length in m.
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
