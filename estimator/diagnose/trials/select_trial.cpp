// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/select_trial.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "estimator/diagnose/fit/free_run_start.h"
#include "estimator/diagnose/locate/locate.h"
#include "estimator/diagnose/propose/name_of_fit.h"
#include "estimator/diagnose/trials/refit.h"
#include "estimator/diagnose/trials/trial_names.h"
#include "estimator/diagnose/trials/trials.h"

namespace framewatch::estimator {
namespace {

constexpr double kMinLeft = 0.02;  ///< of the design's stiffness

struct Rival {
  Trial trial;
  FitResult fit;
};

std::vector<const Trial*> rivals_of(const SearchSettings& settings, const FoundEffect& effect) {
  std::vector<const Trial*> out;
  for (const Trial& t : effect.alternatives) {
    const bool tried = t.outcome == TrialOutcome::fitted || t.outcome == TrialOutcome::screened_out;
    const bool again =
        std::any_of(out.begin(), out.end(), [&](const Trial* o) { return o->kind == t.kind; });
    if (!tried || again || t.second || t.kind == effect.chosen.kind ||
        !(t.place == effect.chosen.place) || t.cost > settings.hopeless * effect.chosen.cost ||
        t.model.effects.empty() || !t.model.effects.back().element_law())
      continue;
    out.push_back(&t);
    if (out.size() == settings.finalists) break;
  }
  return out;
}

bool is_arbitrary_force(const Trial& t) {
  return !t.model.effects.empty() && t.model.effects.back().form == LawForm::broadband;
}

double limit_of(const SearchSettings& settings, const Trial& best, double enough) {
  const double by_cost = settings.hopeless * best.cost;
  if (is_arbitrary_force(best)) return by_cost;
  return std::min(by_cost, enough + settings.hopeless * std::max(0.0, best.cost - enough));
}

/// Refines the leading trials with everything free. enough: cost above which more than chance is
/// left; needed: a reduction that is more than chance. Trials far behind the best one are not
/// rivals.
void refine_leading(const TrialContext& context, double enough, double needed,
                    std::vector<Trial>& trials) {
  const SearchSettings& settings = context.settings();
  const Trial& best = trials.front();
  const bool done = best.cost <= enough && !is_arbitrary_force(best);
  const double limit =
      done ? best.cost + settings.behind * needed : limit_of(settings, best, enough);
  run_all(
      context.parallel, static_cast<int>(std::min(settings.finalists, trials.size())), [&](int i) {
        Trial& t = trials[static_cast<std::size_t>(i)];
        if (t.outcome != TrialOutcome::fitted || t.fraction <= settings.promises || t.cost > limit)
          return;
        const bool late = ends_with_harmonic(t.model) && t.cost > enough;
        if (t.refined || !(late || t.fraction < settings.sharp)) return;
        t = refined(context, t, t.model);
        t.refined = true;
      });
}

/// Refits the leading trials, starting from a fit to the record with the weakest effect.
void approach(const TrialContext& context, double enough, std::vector<Trial>& trials) {
  const SearchSettings& settings = context.settings();
  const double limit = limit_of(settings, trials.front(), enough);
  run_all(context.parallel, static_cast<int>(std::min(settings.finalists, trials.size())),
          [&](int i) {
            Trial& t = trials[static_cast<std::size_t>(i)];
            if (t.outcome != TrialOutcome::fitted || t.fraction <= settings.promises ||
                t.cost > limit || t.approached)
              return;
            t = refined(context, t, fitted_to_the_weakest(context, t.model));
            t.approached = true;
          });
}

}  // namespace

double fitted_values(const Model& model) {
  const auto free = [](const std::vector<LawParameter>& parameters) {
    return std::count_if(parameters.begin(), parameters.end(),
                         [](const LawParameter& k) { return k.free; });
  };
  auto out = static_cast<double>(model.free_gain.size() + model.free_clock.size());
  for (const ModelEffect& e : model.effects) {
    out += static_cast<double>(free(e.parameters));
    for (const std::vector<LawParameter>& parameters : e.record_parameters)
      out += static_cast<double>(free(parameters));
  }
  return out;
}

bool worsens(const Fitter& fitter, const Trial& trial, const FitResult& now, double chance) {
  for (std::size_t r = 0; r < now.misfit.size(); ++r)
    if (trial.misfit[r] > (1 + fitter.settings().same_gap) * now.misfit[r] + chance) return true;
  return false;
}

bool is_nearest_law(const TrialContext& context, const Trial& trial) {
  const FitResult& now = context.now;
  const std::vector<ModelEffect>& effects = trial.model.effects;
  if (trial.outcome != TrialOutcome::fitted || trial.second ||
      effects.size() <= now.model.effects.size() || !effects.back().element_law())
    return false;
  const double noise = context.fitter.expected(now.model);
  return now.cost - trial.cost > context.settings().explains_much * (now.total_misfit() - noise) &&
         !worsens(context.fitter, trial, now, noise * chance_of(context.fitter, now.model));
}

bool select_trial(const TrialContext& context, double bound, double needed,
                  std::vector<Trial>& trials) {
  if (std::none_of(trials.begin(), trials.end(),
                   [](const Trial& t) { return t.outcome == TrialOutcome::fitted; }))
    return false;
  const SearchSettings& settings = context.settings();
  const FitResult& now = context.now;
  const double to_explain = now.cost - bound;
  // Penalties: two effects must beat one by more than chance, an arbitrary force must beat a law,
  // and every fitted value must explain more than it would explain of noise.
  const double of_value = 0.5 * std::log(context.fitter.expected(now.model));
  const auto price = [&](const Trial& t) {
    const bool arbitrary = t.model.effects.size() > now.model.effects.size() &&
                           t.model.effects.back().form == LawForm::broadband;
    return t.cost + of_value * fitted_values(t.model) + (t.second ? needed : 0.0) +
           (arbitrary ? needed + (1 - settings.explains) * std::max(to_explain, 0.0) : 0.0);
  };
  const auto rank = [&] {
    std::stable_sort(trials.begin(), trials.end(), [&](const Trial& a, const Trial& b) {
      const bool fitted_a = a.outcome == TrialOutcome::fitted,
                 fitted_b = b.outcome == TrialOutcome::fitted;
      return fitted_a != fitted_b ? fitted_a : price(a) < price(b);
    });
    for (Trial& t : trials) t.fraction = (now.cost - t.cost) / std::max(to_explain, 1e-9);
  };
  rank();
  refine_leading(context, bound + needed, needed, trials);
  rank();
  if (trials.front().fraction < settings.explains) {
    approach(context, bound + needed, trials);
    rank();
  }
  const Trial& best = trials.front();
  // In a component test the place is known, and real parts follow no law exactly.
  const bool component = context.fitter.plant().equations() == 1;
  const bool most = best.fraction >= (component ? settings.explains_most : settings.explains) ||
                    (best.fraction >= settings.explains_most && best.cost - bound < needed);
  return most && now.cost - best.cost > needed && !worsens(context.fitter, best, now, needed);
}

bool choose_replacement(const TrialContext& context, FoundEffect& effect, FitResult& now) {
  if (effect.index < 0 || effect.chosen.second) return false;
  const auto index = static_cast<std::size_t>(effect.index);
  const std::vector<const Trial*> others = rivals_of(context.settings(), effect);
  if (!now.model.effects[index].element_law() || others.empty()) return false;
  const Plant& plant = context.fitter.plant();
  FitResult without = now;
  without.model.effects.resize(index);
  const TrialContext named{context.fitter, without, context.without, context.parallel,
                           context.progress};
  const auto as_trial = [&](const FitResult& fit) {
    Trial t = effect.chosen;
    t.kind = name_of_fit(context.settings(), fit.model.effects[index],
                         context.fitter.segments().front());
    t.cost = fit.cost;
    t.misfit = fit.misfit;
    t.model = fit.model;
    return t;
  };
  std::vector<Rival> all(others.size() + 1);
  run_all(context.parallel, static_cast<int>(others.size()), [&](int i) {
    const Trial& t = *others[static_cast<std::size_t>(i)];
    Model model = now.model;
    model.effects[index] = t.model.effects.back();
    model.theta =
        (model.theta + t.model.theta - effect.chosen.model.theta).cwiseMax(kMinLeft * plant.design);
    free_shapes(model);
    FitResult fit = fit_to_the_end(context.fitter, model, {});
    if (fit.good) all[static_cast<std::size_t>(i)] = {as_trial(fit), std::move(fit)};
  });
  all.back() = {as_trial(now), now};
  std::erase_if(all, [&](const Rival& r) {
    return !r.fit.good || (&r != &all.back() && !may_be_named(named, r.trial));
  });
  const double of_value = 0.5 * std::log(context.fitter.expected(now.model));
  const auto price = [&](const Rival& r) {
    return r.trial.cost + of_value * fitted_values(r.trial.model);
  };
  const Trial own = all.back().trial;
  std::stable_sort(all.begin(), all.end(),
                   [&](const Rival& a, const Rival& b) { return price(a) < price(b); });
  const bool another = all.front().trial.kind != own.kind;
  std::vector<Trial> trials;
  for (Rival& r : all) trials.push_back(r.trial);
  FoundEffect fresh = effect_of(context.settings(), trials);
  fresh.confidence = std::min(fresh.confidence, effect.confidence);
  if (!another) {
    effect.confidence = fresh.confidence;
    for (const EffectKind kind : fresh.like)
      if (std::find(effect.like.begin(), effect.like.end(), kind) == effect.like.end())
        effect.like.push_back(kind);
    return false;
  }
  fresh.index = effect.index;
  fresh.alternatives.insert(fresh.alternatives.end(), effect.alternatives.begin(),
                            effect.alternatives.end());
  now = std::move(all.front().fit);
  effect = std::move(fresh);
  return true;
}

}  // namespace framewatch::estimator
