#include "estimator/diagnose/trial_names.h"

#include <algorithm>
#include <cmath>

namespace framewatch {
namespace {

constexpr double kDissipates = 0.15;
constexpr double kNarrowestSlip = 0.08;  ///< of a slip zone, in yield deformations

/// Energy that a cycle to the peak deformation takes, over that of the box around its loop.
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
  for (const Stretch& s : fitter.stretches()) out = std::max(out, s.w.maxCoeff() / (2 * M_PI));
  return out;
}

/// Of what its values may be: there the law that is meant is another one.
bool at_the_edge(const Knob& knob) {
  constexpr double kNear = 1e-6;
  return knob.value <= knob.low + kNear || knob.value >= knob.high - kNear;
}

/// A hidden oscillator that is none: its frequency is not seen, its mass more than the frame's that
/// it is on, or its damping has no end.
bool is_no_oscillator(const TrialContext& c, const ModelEffect& effect) {
  const EffectPlace& place = effect.place;
  return effect.knobs[1].plain() > highest_hz(c.fitter) || at_the_edge(effect.knobs[2]) ||
         effect.knobs[0].plain() > c.fitter.plant().structure.frame_mass(place.story, place.frame);
}

/// A spring that pushes, a damper that drives, a base or frames stiffer than rigid.
bool has_wrong_sign(const ModelEffect& effect) {
  using F = LawForm;
  const bool positive = effect.form == F::spring || effect.form == F::damper ||
                        effect.form == F::rocking || effect.form == F::bending;
  return positive && effect.knobs[0].plain() < 0;
}

}  // namespace

bool is_taken_out(const TrialContext& c, EffectKind kind) {
  return std::find(c.without.begin(), c.without.end(), kind) != c.without.end();
}

void take(const TrialContext& c, const FitResult& run, Trial& t) {
  std::size_t next = c.now.model.effects.size();
  const auto name = [&](EffectKind guess) {
    return !is_axis_error(guess) && next < run.model.effects.size()
               ? name_of_fit(run.model.effects[next++], c.fitter.stretches().front())
               : guess;
  };
  t.kind = name(t.kind);
  if (t.second) t.second->first = name(t.second->first);
  t.cost = run.cost + spared(c.fitter, run.model) - spared(c.fitter, c.now.model);
  t.misfit = run.misfit;
  t.model = run.model;
}

bool is_named(const TrialContext& c, const Trial& t) {
  for (std::size_t e = c.now.model.effects.size(); e < t.model.effects.size(); ++e) {
    const ModelEffect& effect = t.model.effects[e];
    if (has_wrong_sign(effect)) return false;
    if (effect.form == LawForm::resonator && is_no_oscillator(c, effect)) return false;
    if (effect.form == LawForm::pinched &&
        (dissipation(effect) < kDissipates || effect.knobs[5].plain() < kNarrowestSlip ||
         at_the_edge(effect.knobs[4]) || at_the_edge(effect.knobs[5])))
      return false;
  }
  return !is_taken_out(c, t.kind) && !(t.second && is_taken_out(c, t.second->first));
}

}  // namespace framewatch
