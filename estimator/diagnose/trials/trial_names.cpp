// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/trial_names.h"

#include <algorithm>
#include <cmath>

#include "estimator/diagnose/law/hysteretic_force.h"
#include "estimator/diagnose/law/law.h"
#include "estimator/diagnose/propose/name_of_fit.h"

namespace framewatch::estimator {
namespace {

/// Returns the energy dissipated in a cycle to the peak deformation, over that of the box around
/// its loop.
double dissipation(const ModelEffect& effect) {
  constexpr int kSteps = 400, kCycles = 2;
  Eigen::VectorXd d(kSteps * kCycles);
  for (Eigen::Index i = 0; i < d.size(); ++i)
    d[i] = effect.deformation * std::sin(2 * M_PI * static_cast<double>(i) / kSteps);
  const Eigen::VectorXd f = law_force(effect.law(0), d, Eigen::VectorXd::Zero(d.size()), 1);
  double work = 0, peak = 0;
  for (Eigen::Index i = kSteps; i < d.size(); ++i) {
    work += 0.5 * (f[i] + f[i - 1]) * (d[i] - d[i - 1]);
    peak = std::max(peak, std::abs(f[i]));
  }
  return work / std::max(4 * peak * effect.deformation, 1e-300);
}

double highest_hz(const Fitter& fitter) {
  double out = 0;
  for (const RecordSegment& s : fitter.segments()) out = std::max(out, s.w.maxCoeff() / (2 * M_PI));
  return out;
}

/// Returns true if a resonator is implausible: its frequency is above the band, its mass exceeds
/// that of its frame, or its damping is at its bound or too strong for a resonance.
bool is_no_oscillator(const TrialContext& c, const ModelEffect& effect) {
  const EffectPlace& place = effect.place;
  return effect.parameters[1].plain() > highest_hz(c.fitter) || at_bound(effect.parameters[2]) ||
         effect.parameters[2].plain() > c.settings().dulled ||
         effect.parameters[0].plain() >
             c.fitter.plant().structure.frame_mass(place.story, place.frame);
}

/// Returns true for a negative spring, damper or rotational flexibility.
bool has_wrong_sign(const ModelEffect& effect) {
  using F = LawForm;
  const bool positive = effect.form == F::spring || effect.form == F::damper ||
                        effect.form == F::rocking || effect.form == F::bending;
  return positive && effect.parameters[0].plain() < 0;
}

/// Returns true if a slack brace yields. One that does not yield is a clearance.
bool yields(const ModelEffect& slack) {
  return slack.parameters[SlackIndex::play].plain() + slack.parameters[SlackIndex::dy].plain() <
         slack.deformation;
}

/// Returns true for a spring that hardens up to a limit. A contact or a power of the deformation,
/// which are fitted too, are the catalog's laws for that.
bool hardens_to_a_limit(const ModelEffect& effect) {
  return effect.form == LawForm::saturating &&
         effect.parameters[SaturationIndex::force].plain() > 0;
}

}  // namespace

bool is_excluded(const TrialContext& c, EffectKind kind) {
  return std::find(c.without.begin(), c.without.end(), kind) != c.without.end();
}

void set_fit(const TrialContext& c, const FitResult& run, Trial& t) {
  std::size_t next = c.now.model.effects.size();
  const auto name = [&](EffectKind guess) {
    return !is_axis_error(guess) && next < run.model.effects.size()
               ? name_of_fit(c.settings(), run.model.effects[next++], c.fitter.segments().front())
               : guess;
  };
  t.kind = name(t.kind);
  if (t.second) t.second->first = name(t.second->first);
  t.cost = run.cost + removed_misfit(c.fitter, run.model) - removed_misfit(c.fitter, c.now.model);
  t.misfit = run.misfit;
  t.model = run.model;
}

bool may_be_named(const TrialContext& c, const Trial& t) {
  for (std::size_t e = c.now.model.effects.size(); e < t.model.effects.size(); ++e) {
    const ModelEffect& effect = t.model.effects[e];
    if (has_wrong_sign(effect)) return false;
    if (effect.form == LawForm::resonator && is_no_oscillator(c, effect)) return false;
    if (effect.form == LawForm::slack && !yields(effect)) return false;
    if (hardens_to_a_limit(effect)) return false;
    const bool slips = effect.form == LawForm::pinched || effect.form == LawForm::slip_lock;
    if (slips && (dissipation(effect) < c.settings().dissipates ||
                  effect.parameters[HysteresisIndex::width].plain() < c.settings().narrowest_slip ||
                  at_bound(effect.parameters[HysteresisIndex::slip]) ||
                  at_bound(effect.parameters[HysteresisIndex::width])))
      return false;
  }
  return !is_excluded(c, t.kind) && !(t.second && is_excluded(c, t.second->first));
}

void name_by_shape(const TrialContext& c, std::vector<FoundEffect>& effects) {
  for (FoundEffect& found : effects) {
    if (found.index < 0) continue;
    const ModelEffect& law = c.now.model.effects[static_cast<std::size_t>(found.index)];
    if (!law.element_law()) continue;
    const EffectKind name = name_of_fit(c.settings(), law, c.fitter.segments().front());
    if (!is_excluded(c, name)) found.chosen.kind = name;
    std::erase(found.like, found.chosen.kind);
  }
}

}  // namespace framewatch::estimator
