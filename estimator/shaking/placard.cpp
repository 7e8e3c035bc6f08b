// SPDX-License-Identifier: MIT
#include "estimator/shaking/placard.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace framewatch::estimator {
namespace {

constexpr std::size_t kModerate = static_cast<std::size_t>(DamageState::moderate),
                      kExtensive = static_cast<std::size_t>(DamageState::extensive);

/// Returns the index of the story most likely in this state; -1: no story is known.
int likeliest(const std::vector<std::array<double, kDamageStates>>& damage, std::size_t state) {
  int out = -1;
  for (std::size_t i = 0; i < damage.size(); ++i) {
    const double p = damage[i][state];
    if (std::isfinite(p) && (out < 0 || p > damage[static_cast<std::size_t>(out)][state]))
      out = static_cast<int>(i);
  }
  return out;
}

}  // namespace

std::array<double, kDamageStates> damage_probabilities(const Fragility& fragility,
                                                       double drift_ratio, double std_error) {
  std::array<double, kDamageStates> out{};
  const double relative = std_error / drift_ratio;
  const double variance = std::log1p(relative * relative);  // of the drift's logarithm
  for (std::size_t i = 0; i < kDamageStates; ++i) {
    const double spread = std::sqrt(fragility.dispersion[i] * fragility.dispersion[i] + variance);
    const double z = std::log(drift_ratio / fragility.median[i]) / spread;
    out[i] = 0.5 * std::erfc(-z / std::numbers::sqrt2);
    if (i > 0) out[i] = std::min(out[i], out[i - 1]);
  }
  return out;
}

std::vector<std::array<double, kDamageStates>> story_damage(
    const std::vector<StoryDrift>& drifts, const std::vector<Fragility>& by_story) {
  std::vector<std::array<double, kDamageStates>> out;
  for (std::size_t i = 0; i < drifts.size(); ++i) {
    const StoryDrift& drift = drifts[i];
    const double error = std::isfinite(drift.std_error) ? drift.std_error : 0;
    out.push_back(drift.ratio > 0 ? damage_probabilities(by_story[i], drift.ratio, error)
                  : drift.known() ? std::array<double, kDamageStates>{}
                                  : std::array{kNaN, kNaN, kNaN, kNaN});
  }
  return out;
}

PlacardChoice choose_placard(const std::vector<StoryDrift>& drifts,
                             const std::vector<std::array<double, kDamageStates>>& damage,
                             const PlacardRules& rules) {
  PlacardChoice out;
  const auto choose = [&](Placard placard, PlacardReason reason, int index, std::size_t state) {
    const auto i = static_cast<std::size_t>(index);
    out.placard = placard;
    out.reason = reason;
    out.story = drifts[i].story;
    out.state = static_cast<DamageState>(state);
    out.probability = damage[i][state];
  };
  int first_open = -1;
  PlacardReason why = PlacardReason::drift_unknown;
  for (std::size_t i = 0; i < drifts.size(); ++i) {
    const StoryDrift& d = drifts[i];
    if (d.known() && !d.interrupted_at_peak() && std::isfinite(d.std_error)) continue;
    out.not_judged.push_back(d.story);
    if (first_open >= 0) continue;
    first_open = static_cast<int>(i);
    why = !d.known()                ? PlacardReason::drift_unknown
          : d.interrupted_at_peak() ? PlacardReason::interruption
                                    : PlacardReason::error_unknown;
  }
  out.judged = out.not_judged.empty();
  const int extensive = likeliest(damage, kExtensive), moderate = likeliest(damage, kModerate);
  const auto reaches = [&](int index, std::size_t state, double rule) {
    return index >= 0 && damage[static_cast<std::size_t>(index)][state] >= rule;
  };
  if (reaches(extensive, kExtensive, rules.unsafe))
    choose(Placard::unsafe, PlacardReason::damage, extensive, kExtensive);
  else if (reaches(moderate, kModerate, rules.restricted))
    choose(Placard::restricted, PlacardReason::damage, moderate, kModerate);
  else if (first_open >= 0)
    choose(Placard::restricted, why, first_open, kModerate);
  else
    choose(Placard::inspected, PlacardReason::no_damage, moderate, kModerate);
  return out;
}

}  // namespace framewatch::estimator
