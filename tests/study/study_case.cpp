// SPDX-License-Identifier: MIT
#include "tests/study/study_case.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "estimator/simulate/building_model.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/study/linear_share.h"
#include "tests/study/study_record.h"

namespace framewatch::study {
namespace {

constexpr double kQuiet_s = 4;
constexpr double kLargestGap = 0.45;  ///< NRMSE; larger gaps mean another building
constexpr int kSizes = 10;            ///< steps of the search
constexpr int kDraws = 6;             ///< places tried
constexpr int kGrowths = 7;           ///< of a size that was too small to show

double uniform(estimator::Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

estimator::PlanMotion shaking(const CaseOptions& o, double first_mode_hz, std::uint64_t seed,
                              estimator::Random& random) {
  const auto along = [&](std::uint64_t own) {
    estimator::KanaiTajimi p;
    p.ground_frequency_hz = first_mode_hz * uniform(random, 1.0, 2.0);
    p.high_pass_hz = 0.3 * first_mode_hz;
    p.peak_mps2 = uniform(random, 1.5, 2.5);
    p.duration_s = o.seconds - kQuiet_s;
    p.strong_s = 0.6 * o.seconds;
    p.decay_s = 0.1 * o.seconds;
    p.seed = own;
    estimator::GroundMotion motion = kanai_tajimi(p);
    motion.accel.insert(motion.accel.begin(), static_cast<std::size_t>(kQuiet_s / motion.step_s),
                        0.0);
    return motion;
  };
  return {along(2 * seed), along(2 * seed + 1)};
}

Draw draw_hidden(const std::string& name, const StudyBuilding& b, const Peaks& peaks,
                 estimator::Random& random) {
  if (const auto kind = estimator::find_effect(name)) return draw_effect(*kind, b, peaks, random);
  return draw_law(name, b, peaks, random);
}

/// Returns the train record of the case with an effect of this size; empty if the building becomes
/// unstable.
std::optional<Eigen::MatrixXd> record_with(const Draw& draw, double size, StudyCase c) {
  c.hidden = {{}, {}, c.building.theta};
  draw.make(size, c.hidden);
  if (!stands(c.building.truth, c.building.table(), c.hidden.theta, c.hidden.effects)) return {};
  Eigen::MatrixXd accel = clean_record(c, 0);
  if (!accel.allFinite()) return {};
  return accel;
}

/// Returns the smallest size, on a geometric ladder, whose gap reaches `wanted`; 0 if none does.
double size_for(const Draw& draw, double wanted, const StudyCase& c, const LinearShare& share,
                double& gap) {
  const auto gap_of = [&](double size) {
    const auto accel = record_with(draw, size, c);
    return accel ? share.unexplained(*accel, draw.of_channel, 0.5 * wanted) : -1.0;
  };
  if (draw.sizeless) return gap = gap_of(1), gap >= 0 ? 1.0 : 0.0;
  double low = 0, high = draw.largest;
  gap = gap_of(high);
  for (int i = 0; gap < 0 && i < kSizes; ++i) gap = gap_of(high *= 0.7);
  if (gap < wanted) return 0;
  for (int i = 0; i < kSizes && gap > 1.1 * wanted; ++i) {
    const double middle = low > 0 ? std::sqrt(low * high) : high / 3;
    const double found = gap_of(middle);
    if (found >= wanted) {
      high = middle;
      gap = found;
    } else {
      low = middle;
    }
  }
  return high;
}

/// Returns the size, grown until its gap reaches the wanted one with the linear building fitted to
/// convergence; 0 if it never does.
double settled(const Draw& draw, double size, double least, const StudyCase& c,
               const LinearShare& share, double& gap) {
  for (int i = 0; i < kGrowths; ++i) {
    const auto accel = record_with(draw, size, c);
    if (!accel) return 0;
    gap = std::min(gap, share.unexplained_at_the_end(*accel, draw.of_channel));
    if (gap >= least) return size;
    if (draw.sizeless || size >= draw.largest) return 0;
    size = std::min(draw.largest, size * std::clamp(1.1 * least / gap, 1.2, 1.7));
    gap = 1e9;
  }
  return 0;
}

std::vector<std::string> parts_of(const std::string& name) {
  std::vector<std::string> out;
  if (name.empty() || name == "none") return out;
  std::istringstream all(name);
  for (std::string part; std::getline(all, part, '+');) out.push_back(part);
  return out;
}

/// Returns dashpots from every floor to the ground, proportional to the masses.
std::vector<estimator::Effect> ground_dampers(const estimator::Structure& s, double per_kg) {
  std::vector<estimator::Effect> out;
  for (int story = 1; per_kg > 0 && story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f) {
      estimator::EffectPlace place;
      place.kind = estimator::PlaceKind::node_pair;
      place.story = story;
      place.frame = f;
      place.to_story = 0;
      out.push_back(make_effect(estimator::EffectKind::added_damper, place));
      out.back().values.front() = per_kg * s.frame_mass(story, f);
    }
  return out;
}

/// Returns true if a softening building stays stable in the record that does not determine sizes.
bool stands_through_holdout(StudyCase c, const Hidden& hidden) {
  c.hidden = hidden;
  return clean_record(c, 1).allFinite();
}

}  // namespace

std::optional<StudyCase> make_case(const std::string& group, const std::string& name,
                                   const CaseOptions& options, std::string& why_not) {
  StudyCase c;
  c.options = options;
  c.group = group;
  c.name = name;
  estimator::Random random(options.seed, 1);
  const bool rigid = name.find("floor_flexibility") != std::string::npos;
  c.building = random_building(
      options.building, rigid ? estimator::FloorModel::rigid : estimator::FloorModel::flexible,
      random);
  c.hidden.theta = c.building.theta;
  const double f1 =
      natural_frequencies_hz(c.building.truth, c.building.table(), c.building.theta).front();
  c.ground_dampers = ground_dampers(c.building.truth, 0.01 * options.mass_damping * 4 * M_PI * f1);
  for (std::uint64_t record = 0; record < 2; ++record)
    c.motions.push_back(shaking(options, f1, 2 * options.seed + record, random));
  const std::vector<std::string> parts = parts_of(name);
  if (parts.empty()) return c;

  c.filtered = std::find(parts.begin(), parts.end(), "time_shift") != parts.end();
  const LinearShare share(c);
  const double floor = share.noise_floor(options.noise_ratio);
  c.gap_over_floor = 1e9;
  Hidden all = c.hidden;
  for (const std::string& part : parts) {
    bool found = false;
    for (int attempt = 0; attempt < kDraws && !found; ++attempt) {
      const Draw draw = draw_hidden(part, c.building, share.peaks(), random);
      const double wanted =
          std::min(options.least_gap * floor * std::exp(uniform(random, 0.05, 0.9)),
                   std::max(kLargestGap, 1.05 * options.least_gap * floor));
      double gap = 0;
      double size = size_for(draw, wanted, c, share, gap);
      if (size == 0 && gap >= options.least_gap * floor) size = draw.largest;
      if (size == 0 || gap < options.least_gap * floor) continue;
      size = settled(draw, size, options.least_gap * floor, c, share, gap);
      if (size == 0) continue;
      Hidden with = all;
      draw.make(size, with);
      if (!stands_through_holdout(c, with)) continue;
      found = true;
      all = with;
      c.gap_over_floor = std::min(c.gap_over_floor, gap / floor);
    }
    if (!found) {
      why_not = part + ": no size of it shows above the noise";
      return std::nullopt;
    }
  }
  c.hidden = all;
  return c;
}

}  // namespace framewatch::study
