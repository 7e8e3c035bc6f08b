// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "estimator/numeric/nan.h"
#include "estimator/shaking/story_drift.h"

namespace framewatch::estimator {

/// Damage states of a story's structure, as HAZUS names them.
enum class DamageState { slight, moderate, extensive, complete };
inline constexpr std::size_t kDamageStates = 4;

/// Story drift at which damage states begin: lognormal, by DamageState.
struct Fragility {
  std::array<double, kDamageStates> median{};      ///< drift over story height
  std::array<double, kDamageStates> dispersion{};  ///< standard deviation of the logarithm
};

/// Returns the probabilities that a story is in a damage state or a worse one, by DamageState; NaN
/// when an argument is NaN. drift_ratio: the peak drift, > 0. std_error: >= 0; it widens the
/// dispersion. A worse state is never more likely than a lighter one. docs/equations.md (63).
std::array<double, kDamageStates> damage_probabilities(const Fragility& fragility,
                                                       double drift_ratio, double std_error);

/// The words of ATC-20. The placard is an indication for the inspecting engineer and does not
/// replace the inspection.
enum class Placard { inspected, restricted, unsafe };

/// Probabilities at which a placard is given. The default is a quarter because errors do not cost
/// alike: closing a sound building costs days, entering one that may fall costs lives.
struct PlacardRules {
  double restricted = 0.25;  ///< of moderate or worse damage in any story
  double unsafe = 0.25;      ///< of extensive or worse damage in any story
};

enum class PlacardReason {
  damage,         ///< a probability reaches its rule
  no_damage,      ///< no probability reaches its rule
  drift_unknown,  ///< a story's drift is not known
  interruption,   ///< the record is interrupted at a story's peak
  error_unknown   ///< the error of a story's drift is not known
};

/// The placard and the story that decides it.
struct PlacardChoice {
  Placard placard = Placard::restricted;
  PlacardReason reason = PlacardReason::drift_unknown;
  int story = 0;                              ///< from 1
  DamageState state = DamageState::moderate;  ///< whose probability decided
  double probability = kNaN;                  ///< NaN: the reason has no probability
  /// False if a story could not be judged; the placard is then at least restricted.
  bool judged = true;
  std::vector<int> not_judged = {};  ///< stories that could not be judged
};

/// Returns the damage probabilities of every story. drifts: from story_drifts(). NaN if the drift
/// is not known; an unknown error counts as 0.
std::vector<std::array<double, kDamageStates>> story_damage(const std::vector<StoryDrift>& drifts,
                                                            const std::vector<Fragility>& by_story);

/// Chooses the placard. drifts and damage: of the same stories, at least one. Unsafe when a known
/// story reaches rules.unsafe; else restricted when a story cannot be judged or reaches
/// rules.restricted.
PlacardChoice choose_placard(const std::vector<StoryDrift>& drifts,
                             const std::vector<std::array<double, kDamageStates>>& damage,
                             const PlacardRules& rules);

}  // namespace framewatch::estimator
