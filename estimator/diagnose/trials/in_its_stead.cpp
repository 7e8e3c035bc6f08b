#include "estimator/diagnose/trials/in_its_stead.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "estimator/diagnose/propose/name_of_fit.h"
#include "estimator/diagnose/trials/needless.h"
#include "estimator/diagnose/trials/select_trial.h"
#include "estimator/diagnose/trials/sharpened.h"
#include "estimator/diagnose/trials/trial_names.h"
#include "estimator/diagnose/trials/trials.h"

namespace framewatch::estimator {
namespace {

constexpr std::size_t kMaxRivals = 3;
constexpr double kFarBehind = 4;   ///< times the cost of the chosen law
constexpr double kMinLeft = 0.02;  ///< of the design's stiffness

struct Rival {
  Trial trial;
  FitResult fit;
};

std::vector<const Trial*> rivals_of(const FoundEffect& effect) {
  std::vector<const Trial*> out;
  for (const Trial& t : effect.alternatives) {
    const bool tried = t.outcome == TrialOutcome::fitted || t.outcome == TrialOutcome::screened_out;
    const bool again =
        std::any_of(out.begin(), out.end(), [&](const Trial* o) { return o->kind == t.kind; });
    if (!tried || again || t.second || t.kind == effect.chosen.kind ||
        !(t.place == effect.chosen.place) || t.cost > kFarBehind * effect.chosen.cost ||
        t.model.effects.empty() || !t.model.effects.back().element_law())
      continue;
    out.push_back(&t);
    if (out.size() == kMaxRivals) break;
  }
  return out;
}

}  // namespace

bool choose_again(const TrialContext& context, FoundEffect& effect, FitResult& now) {
  if (effect.index < 0 || effect.chosen.second) return false;
  const auto index = static_cast<std::size_t>(effect.index);
  const std::vector<const Trial*> others = rivals_of(effect);
  if (!now.model.effects[index].element_law() || others.empty()) return false;
  const Plant& plant = context.fitter.plant();
  FitResult without = now;
  without.model.effects.resize(index);
  const TrialContext named{context.fitter, without, context.without, context.parallel,
                           context.progress};
  const auto as_trial = [&](const FitResult& fit) {
    Trial t = effect.chosen;
    t.kind = name_of_fit(fit.model.effects[index], context.fitter.segments().front());
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
  FoundEffect fresh = effect_of(trials);
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
