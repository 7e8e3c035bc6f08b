#include "daemon/config/plausibility/doubted_design.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>

#include <fmt/core.h>

#include "daemon/config/plausibility/plausible_limits.h"
#include "daemon/config/plausibility/value_place.h"
#include "estimator/numeric/eigenvalues.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::daemon {
namespace {

/// Larger buildings would keep a person waiting for dense matrices.
constexpr int kMaxDegreesOfFreedom = 200;
/// What a thousand times in stiffness or mass makes of a frequency.
constexpr double kThousandfold = 31.6;

/// The unit with which the frequency would be what it should be.
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

/// Of the mode that is lowest without damping. Empty for a large building.
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

/// Frames of one direction, summed over each story.
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
  std::nth_element(sorted.begin(), sorted.begin() + s.stories / 2, sorted.end());
  const double usual = sorted[static_cast<std::size_t>(s.stories / 2)];
  const auto odd = *most / usual > usual / *least ? most : least;
  doubts.push_back(
      {place_in(section, key, static_cast<std::size_t>(odd - stories.begin()), stories.size()),
       fmt::format("structure.design.{}: story {} has {:.3g} N/m in all, story {} {:.3g} N/m; "
                   "stories of one building hardly differ by more than {:g} times: a power of ten "
                   "too many or too few?",
                   key, most - stories.begin() + 1, *most, least - stories.begin() + 1, *least,
                   kMaxUnequalStories)});
}

}  // namespace

void doubt_design(const TomlValue& section, const estimator::Structure& s,
                  const Eigen::VectorXd& design, std::vector<TextProblem>& doubts) {
  const estimator::ParameterTable table(s);
  doubt_frequency(section, s, lowest_frequency_hz(s, table, design), doubts);
  if (const auto ratio = first_damping_ratio(s, table, design))
    doubt_damping(section, *ratio, doubts);
  doubt_unequal_stories(section, "kx_npm", s, 0, s.n(), design, doubts);
  doubt_unequal_stories(section, "ky_npm", s, s.n(), s.m(), design, doubts);
}

}  // namespace framewatch::daemon
