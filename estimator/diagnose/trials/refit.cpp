// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/refit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "estimator/diagnose/fit/free_run_start.h"
#include "estimator/diagnose/fit/judged_fit.h"
#include "estimator/diagnose/law/hysteretic_force.h"
#include "estimator/diagnose/propose/law_starts.h"
#include "estimator/diagnose/propose/name_of_fit.h"
#include "estimator/diagnose/trials/trial_names.h"

namespace framewatch::estimator {
namespace {

void fix_exponent(EffectKind kind, ModelEffect& effect) {
  if (kind == EffectKind::coulomb_friction && effect.form == LawForm::power_damping) {
    effect.form = LawForm::friction;
    effect.parameters[1] =
        logarithmic_parameter(0.01 * effect.rate, 1e-4 * effect.rate, 0.3 * effect.rate);
    return;
  }
  if (effect.form == LawForm::pinched && kind != EffectKind::pinching) {
    effect = without_slip(effect);
    if (kind == EffectKind::bilinear_hysteresis) effect.parameters.resize(HysteresisIndex::kOwn);
    return;
  }
  if (effect.form == LawForm::asymptotic) {
    const double spread = spread_like(effect.parameters[AsymptoteIndex::sharpness].plain());
    effect.form = LawForm::sliders;
    effect.parameters.resize(2);
    effect.parameters.push_back(bounded_parameter(spread, 0.02, 0, 0.98));
    effect.parameters.push_back(bounded_parameter(0, 0.005, 0, 5, false));
    return;
  }
  const bool elastic =
      kind == EffectKind::cubic_stiffness || kind == EffectKind::quadratic_stiffness;
  if (elastic && is_contact(effect.form)) effect = two_slopes(effect);
  if (effect.form != LawForm::power && effect.form != LawForm::power_damping) return;
  LawParameter& exponent = effect.parameters[1];
  const double value = kind == EffectKind::cubic_stiffness ? 3 : 2;
  exponent.value = exponent.logarithmic ? std::log(value) : value;
  exponent.free = false;
}

/// Replaces `now` by the fit of a smaller model, started from it, unless that is worse. Returns
/// true if it was replaced.
bool replaced_by(const Fitter& fitter, const Model& smaller, FitResult& now) {
  FitResult less = fit_to_the_end(fitter, smaller, now.motion);
  if (!less.good || less.cost > now.cost + fitter.settings().min_gain) return false;
  now = std::move(less);
  return true;
}

}  // namespace

void free_shapes(Model& model) {
  for (ModelEffect& e : model.effects) free_shape(e);
}

Model fitted_to_the_weakest(const TrialContext& c, const Model& model) {
  const bool of_records =
      std::any_of(model.effects.begin(), model.effects.end(),
                  [](const ModelEffect& e) { return !e.record_parameters.empty(); });
  const std::vector<RecordSegment>& all = c.fitter.segments();
  if (all.size() < 2 || of_records) return model;
  const auto strength = [&](std::size_t r) {
    return c.now.misfit[r] / c.fitter.expected(r, c.now.model);
  };
  std::size_t weakest = 0;
  for (std::size_t r = 1; r < all.size(); ++r)
    if (strength(r) < strength(weakest)) weakest = r;
  const std::vector<RecordSegment> one{all[weakest]};
  const Fitter alone = c.fitter.with(one);
  const FitResult run = alone.fit(model, {}, thorough(model, c.settings().steps));
  return run.good ? run.model : model;
}

Trial refined(const TrialContext& c, const Trial& trial, const Model& from) {
  Model start = from;
  free_shapes(start);
  FitResult run = c.fitter.fit(start, {}, thorough(start, c.settings().longest_steps));
  if (!run.good) return trial;
  if (ends_with_harmonic(run.model)) run = with_onsets(c.fitter, std::move(run));
  Trial out = trial;
  set_fit(c, run, out);
  return out.cost < trial.cost && may_be_named(c, out) ? out : trial;
}

FitResult fit_to_the_end(const Fitter& fitter, const Model& model,
                         const std::vector<Eigen::MatrixXcd>& motion) {
  FitResult out = fitter.fit(model, motion, thorough(model, fitter.settings().steps));
  FitOptions along = thorough(out.model, fitter.settings().steps);
  along.through_run = false;
  FitResult more = fitter.fit(out.model, out.motion, along);
  return more.good && more.cost < out.cost ? more : out;
}

bool remove_redundant(const Fitter& fitter, const Model& before, FitResult& now) {
  Model start = now.model;
  start.effects.resize(before.effects.size());
  start.free_gain = before.free_gain;
  start.free_clock = before.free_clock;
  return replaced_by(fitter, start, now);
}

double gap_ratio(const Fitter& fitter, const Model& with, const Model& without,
                 const Parallel& parallel) {
  const Model* models[] = {&with, &without};
  double gaps[2];
  run_all(parallel, 2, [&](int i) {
    gaps[i] = judged_fit(fitter, {*models[i]}, fitter.settings().steps, fitter.within()).gap;
  });
  return gaps[0] / gaps[1];
}

bool is_redundant(const Fitter& fitter, const Model& with, const Model& without,
                  const Parallel& parallel) {
  const double first = free_run_fit(fitter, {without}, fitter.settings().rough_steps, false).gap;
  if (rms_gap(fitter, with) < fitter.settings().clearly_less * first) return false;
  return gap_ratio(fitter, with, without, parallel) > 1 - fitter.settings().same_gap;
}

void hold_axis(const Plant& plant, int axis, Model& model) {
  const Model none = initial_model(plant);
  std::erase(model.free_gain, axis);
  std::erase(model.free_clock, axis);
  model.gain[axis] = none.gain[axis];
  model.clock_s[axis] = none.clock_s[axis];
}

Model without_effects(const Model& model, const std::vector<FoundEffect>& effects,
                      std::size_t first, std::size_t end, const Plant& plant) {
  Model out = model;
  std::vector<int> leaving;
  for (std::size_t i = first; i < end; ++i) {
    const FoundEffect& e = effects[i];
    if (e.index >= 0)
      leaving.push_back(e.index);
    else if (e.ramp_mps3.empty())
      hold_axis(plant, e.chosen.place.channel, out);
  }
  std::sort(leaving.rbegin(), leaving.rend());
  for (const int index : leaving) out.effects.erase(out.effects.begin() + index);
  return out;
}

void erase_effect(std::size_t i, std::vector<FoundEffect>& effects) {
  const int index = effects[i].index;
  effects.erase(effects.begin() + static_cast<std::ptrdiff_t>(i));
  if (index < 0) return;
  for (FoundEffect& e : effects) e.index -= e.index > index;
}

void remove_not_needed(const Fitter& fitter, const Parallel& parallel,
                       std::vector<FoundEffect>& effects, FitResult& now) {
  while (effects.size() > 1) {
    std::vector<FitResult> less(effects.size());
    run_all(parallel, static_cast<int>(effects.size()), [&](int i) {
      const auto at = static_cast<std::size_t>(i);
      const Model model = without_effects(now.model, effects, at, at + 1, fitter.plant());
      const FitResult rough =
          fitter.fit(model, now.motion, thorough(model, fitter.settings().rough_steps));
      if (rough.good && rough.cost < fitter.settings().hopeless * now.cost)
        less[at] = fit_to_the_end(fitter, rough.model, rough.motion);
    });
    const auto best = std::min_element(less.begin(), less.end(), is_better);
    if (!best->good || best->cost > now.cost + fitter.settings().min_gain) return;
    now = std::move(*best);
    erase_effect(static_cast<std::size_t>(best - less.begin()), effects);
  }
}

void remove_earlier_redundant(const Fitter& fitter, std::vector<FoundEffect>& effects,
                              FitResult& now) {
  for (std::size_t i = 0; i + 1 < effects.size(); ++i) {
    const int index = effects[i].index;
    if (index < 0 || now.model.effects[static_cast<std::size_t>(index)].element_law()) continue;
    if (!replaced_by(fitter, without_effects(now.model, effects, i, i + 1, fitter.plant()), now))
      continue;
    erase_effect(i, effects);
    effects.back().chosen.model = now.model;
    --i;
  }
}

Model declared_model(const Plant& plant, const std::vector<RecordSegment>& segments,
                     const Model& fitted,
                     const std::vector<const std::vector<FoundEffect>*>& effects,
                     const Parallel& within) {
  Model out = fitted;
  for (const std::vector<FoundEffect>* list : effects)
    for (const FoundEffect& found : *list)
      if (found.index >= 0)
        fix_exponent(found.chosen.kind, out.effects[static_cast<std::size_t>(found.index)]);
  const Model none = initial_model(plant);
  const auto shrink = [&](Eigen::VectorXd Model::*errors, double share,
                          const std::vector<int>& free) {
    for (Eigen::Index a = 0; a < (out.*errors).size(); ++a)
      if (std::find(free.begin(), free.end(), static_cast<int>(a)) == free.end())
        (out.*errors)[a] = share * (fitted.*errors)[a] + (1 - share) * (none.*errors)[a];
  };
  const Fitter exact(plant, segments, {0, 0, 0}, within);
  // In small steps: the fit of a stiff law may not converge if all errors are removed at once.
  for (const double share : {0.75, 0.5, 0.25, 0.0}) {
    shrink(&Model::mass_change, share, {});
    shrink(&Model::gain, share, out.free_gain);
    shrink(&Model::clock_s, share, out.free_clock);
    FitOptions options =
        thorough(out, share > 0 ? exact.settings().first_steps : exact.settings().steps);
    options.through_run = share == 0;
    const FitResult next = exact.fit(out, {}, options);
    if (next.good) out = next.model;
  }
  return out;
}

}  // namespace framewatch::estimator
