// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/evidence.h"

#include <limits>
#include <numeric>
#include <utility>

#include "estimator/diagnose/fit/fit.h"

namespace framewatch::estimator {
namespace {

/// Returns the places of the named element laws. Without them, returns the likeliest element.
std::vector<EffectPlace> shown_places(const Diagnosis& d) {
  std::vector<EffectPlace> out;
  for (const FoundEffect& f : d.effects) {
    if (f.index < 0) continue;
    const ModelEffect& e = d.model.effects[static_cast<std::size_t>(f.index)];
    if (e.element_law()) out.push_back(e.place);
  }
  if (!out.empty() || !d.effects.empty() || d.verdict == Verdict::adequate) return out;
  for (const WhereEntry& w : d.where)
    if (w.place.kind == PlaceKind::frame || w.place.kind == PlaceKind::panel) return {w.place};
  return out;
}

}  // namespace

Evidence evidence_of(const Plant& plant, const std::vector<RecordSegment>& segments,
                     std::size_t holdout_from, const Diagnosis& d) {
  Evidence out;
  if (segments.empty() || d.before.size() < segments.size()) return out;
  const std::size_t from = holdout_from < segments.size() ? holdout_from : 0;
  const std::size_t last = segments.size() - 1;
  for (const EffectPlace& place : shown_places(d)) {
    auto force = force_at(plant, d.before_model, d.after_model, segments[last], last, place);
    if (force) out.forces.push_back(std::move(*force));
  }
  out.spectrum = residual_spectrum(plant, segments, d.before, d.after, from);
  out.floors = floor_gaps(plant, segments, d.before, d.after, from);
  out.correlation = residual_correlation(plant, segments, d.before, d.after, from);
  return out;
}

double misfit_ratio(const Plant& plant, const std::vector<RecordSegment>& segments,
                    const Trial& trial) {
  if (trial.outcome != TrialOutcome::fitted || trial.misfit.size() != segments.size())
    return std::numeric_limits<double>::quiet_NaN();
  const double expected = Fitter(plant, segments, {}).expected(trial.model);
  return std::accumulate(trial.misfit.begin(), trial.misfit.end(), 0.0) / expected;
}

}  // namespace framewatch::estimator
