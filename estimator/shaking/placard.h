#pragma once

#include <array>
#include <vector>

#include "estimator/numeric/nan.h"
#include "estimator/shaking/fragility.h"
#include "estimator/shaking/story_drift.h"

namespace framewatch::estimator {

/// The words of ATC-20. An indication for the engineer who inspects; no inspection.
enum class Placard { inspected, restricted, unsafe };

/// Probabilities from which on a placard is given. A quarter by default: mistakes do not cost
/// alike. Closing a sound building costs days, entering one that may fall costs lives.
struct PlacardRules {
  double restricted = 0.25;  ///< of moderate or worse damage in any story
  double unsafe = 0.25;      ///< of extensive or worse damage in any story
};

enum class PlacardReason {
  damage,         ///< the probability reaches its rule
  no_damage,      ///< it does in no story
  drift_unknown,  ///< of a story
  gap,            ///< the record has a gap at the peak of a story
  error_unknown   ///< of a story's drift
};

/// The placard and the story that decides it.
struct PlacardChoice {
  Placard placard = Placard::restricted;
  PlacardReason reason = PlacardReason::drift_unknown;
  int story = 0;                              ///< from 1
  DamageState state = DamageState::moderate;  ///< whose probability decided
  double probability = kNaN;                  ///< NaN: of reasons without one
  /// False where a story could not be judged: restricted at best.
  bool judged = true;
  std::vector<int> not_judged = {};  ///< stories that could not be judged
};

/// By damage state, of every story: as story_drifts() gives them. NaN where the drift is not known.
/// Where the error is not known it counts as none.
std::vector<std::array<double, kDamageStates>> story_damage(const std::vector<StoryDrift>& drifts,
                                                            const std::vector<Fragility>& by_story);

/// drifts and damage: of the same stories, at least one. Unsafe when a known story reaches
/// rules.unsafe; else restricted when one cannot be judged or reaches rules.restricted.
PlacardChoice choose_placard(const std::vector<StoryDrift>& drifts,
                             const std::vector<std::array<double, kDamageStates>>& damage,
                             const PlacardRules& rules);

}  // namespace framewatch::estimator
