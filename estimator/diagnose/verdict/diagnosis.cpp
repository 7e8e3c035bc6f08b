// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/diagnose/trials/round_trials.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kTail = 0.05;         ///< of the energy before, and after
constexpr std::size_t kDescribed = 3;  ///< places whose signal is described

/// Returns the first and last index between the tails of the sum.
std::pair<Index, Index> middle(const VectorXd& energy) {
  const double total = energy.sum();
  Index first = 0, last = energy.size() - 1;
  double seen = 0;
  for (Index i = 0; i < energy.size(); ++i) {
    if (seen < kTail * total) first = i;
    seen += energy[i];
    if (seen < (1 - kTail) * total) last = std::min(i + 1, energy.size() - 1);
  }
  return {first, last};
}

/// Returns true if the place is a floor in one direction, or relative to another floor, where a
/// contact may act.
bool is_floor(const Localisation& place) {
  const CandidatePlace& at = place.candidate_places.front();
  const bool floor = at.kind == CandidatePlace::Kind::node || at.kind == CandidatePlace::Kind::link;
  return floor && at.size() == 1 && at.place.story >= 2;
}

/// Returns the kind of force of an element. For a floor, where any force may act, returns it only
/// if the force follows the floor's motion.
std::optional<KindOfLaw> kind_at(const Fitter& fitter, const Localisation& place,
                                 std::vector<NeededSignal> needed) {
  if (is_floor(place)) set_motion_of_floor(fitter, place, needed);
  KindOfLaw kind = kind_of_law(fitter, needed);
  if (is_floor(place) && !follows_motion(kind.kind)) return {};
  return kind;
}

void describe_signal(const Fitter& fitter, const Localisation& place, bool kind,
                     WhereEntry& entry) {
  const std::vector<NeededSignal> needed = needed_signals(fitter, place);
  if (kind) entry.kind = kind_at(fitter, place, needed);
  double most = -1;
  for (std::size_t r = 0; r < needed.size(); ++r) {
    // Without the noise of the needed signal.
    const VectorXd power =
        (needed[r].force.cwiseAbs2() - needed[r].weight.cwiseInverse()).cwiseMax(0.0);
    if (power.sum() <= most) continue;
    most = power.sum();
    const RecordSegment& s = fitter.segments()[r];
    entry.record = r;
    const auto [low, high] = middle(power);
    entry.low_hz = s.w[low] / (2 * M_PI);
    entry.high_hz = s.w[high] / (2 * M_PI);
    const VectorXd signal = signal_of(needed[r].force, s, 1);
    const auto [from, to] = middle(signal.cwiseAbs2());
    entry.from_s = static_cast<double>(from) / s.rate_hz;
    entry.to_s = static_cast<double>(to) / s.rate_hz;
    entry.peak = signal.cwiseAbs().maxCoeff();
  }
}

}  // namespace

std::vector<WhereEntry> where_of(const Fitter& fitter, const std::vector<Localisation>& places) {
  std::vector<WhereEntry> out;
  bool element = false, floor = false;
  for (const Localisation& place : places) {
    WhereEntry entry;
    entry.place = place.candidate_places.front().place;
    entry.ratio = place.ratio;
    const bool first_element = !element && is_element(place);
    const bool first_floor = !floor && is_floor(place);
    if (out.size() < kDescribed) {
      describe_signal(fitter, place, first_element || first_floor, entry);
      element |= first_element;
      floor |= first_floor;
    }
    out.push_back(entry);
  }
  return out;
}

std::vector<WhereEntry> map_of(const Located& located) {
  std::vector<WhereEntry> out;
  const auto add = [&](const Localisation& place) {
    WhereEntry entry;
    entry.place = place.candidate_places.front().place;
    entry.ratio = place.ratio;
    const auto same = [&](const WhereEntry& e) { return e.place == entry.place; };
    if (std::none_of(out.begin(), out.end(), same)) out.push_back(entry);
  };
  for (const Localisation& place : located.places) add(place);
  for (const Localisation& place : located.once) add(place);
  std::stable_sort(out.begin(), out.end(),
                   [](const WhereEntry& a, const WhereEntry& b) { return a.ratio < b.ratio; });
  return out;
}

}  // namespace framewatch::estimator
