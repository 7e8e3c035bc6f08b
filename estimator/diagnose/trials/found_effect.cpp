// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/found_effect.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/diagnose/trials/trial.h"

namespace framewatch::estimator {
namespace {

/// margin: cost of the best rival minus that of the effect.
double confidence_of(const SearchSettings& settings, double margin) {
  return std::min(settings.surest, 1 - kDoubtful * std::exp(-margin / settings.doubt_cost));
}

}  // namespace

std::vector<const Trial*> near_rivals(const SearchSettings& settings, const FoundEffect& effect,
                                      double confidence) {
  std::vector<const Trial*> out;
  if (std::isnan(effect.chosen.fraction)) return out;
  for (const Trial& t : effect.alternatives)
    if (is_rival(t, effect.chosen) &&
        confidence_of(settings, std::max(0.0, t.cost - effect.chosen.cost)) < confidence)
      out.push_back(&t);
  std::stable_sort(out.begin(), out.end(),
                   [](const Trial* a, const Trial* b) { return a->cost < b->cost; });
  return out;
}

FoundEffect effect_of(const SearchSettings& settings, const std::vector<Trial>& trials) {
  const Trial& best = trials.front();
  FoundEffect out;
  out.chosen = best;
  out.alternatives = without_duplicates(trials);
  out.alternatives.erase(out.alternatives.begin());
  for (const Trial& t : out.alternatives)
    if (is_rival(t, best) && t.cost < best.cost + settings.same_cost && t.kind != best.kind &&
        std::find(out.like.begin(), out.like.end(), t.kind) == out.like.end())
      out.like.push_back(t.kind);
  const auto rival =
      std::find_if(trials.begin(), trials.end(), [&](const Trial& t) { return is_rival(t, best); });
  const double margin = rival == trials.end() ? std::numeric_limits<double>::infinity()
                                              : std::max(0.0, rival->cost - best.cost);
  out.confidence = out.like.empty() ? confidence_of(settings, margin) : kDoubtful;
  return out;
}

}  // namespace framewatch::estimator
