#include "estimator/diagnose/settle.h"

#include <algorithm>
#include <cmath>

#include "estimator/diagnose/onset.h"

namespace framewatch {
namespace {

constexpr double kTakesAway = 0.97;  ///< of the misfit beyond noise, else a law is not named
constexpr double kTakesMost = 0.9;   ///< the same where the rest is within chance
constexpr double kSharp = 0.995;     ///< share above which a fit need not be sharpened
constexpr double kBlunt = 0.4;       ///< share below which it is not worth it
constexpr std::size_t kSharpened = 3;
constexpr double kWorse = 1.02;  ///< misfit of a record, relative
/// Of the excess: what an arbitrary force must be better by than a law.
constexpr double kOwnPrice = 1 - kTakesAway;

/// How many values of a model are fitted beyond those of the linear building.
double fitted_values(const Model& model) {
  const auto free = [](const std::vector<Knob>& knobs) {
    return std::count_if(knobs.begin(), knobs.end(), [](const Knob& k) { return k.free; });
  };
  auto out = static_cast<double>(model.free_gain.size() + model.free_clock.size());
  for (const ModelEffect& e : model.effects) {
    out += static_cast<double>(free(e.knobs));
    for (const std::vector<Knob>& knobs : e.record_knobs) out += static_cast<double>(free(knobs));
  }
  return out;
}

/// enough: cost beyond which more than chance is left.
void sharpen(const TrialContext& context, double enough, std::vector<Trial>& trials) {
  run_all(context.parallel, static_cast<int>(std::min(kSharpened, trials.size())), [&](int i) {
    Trial& t = trials[static_cast<std::size_t>(i)];
    if (t.fate != Fate::fitted || t.fraction <= kBlunt) return;
    const bool late = ends_with_harmonic(t.model) && t.cost > enough;
    if (late || t.fraction < kSharp) t = sharpened(context, t, t.model);
  });
}

/// The leading ones once more by way of the weakest record.
void approach(const TrialContext& context, std::vector<Trial>& trials) {
  run_all(context.parallel, static_cast<int>(std::min(kSharpened, trials.size())), [&](int i) {
    Trial& t = trials[static_cast<std::size_t>(i)];
    if (t.fate == Fate::fitted && t.fraction > kBlunt)
      t = sharpened(context, t, fitted_to_the_weakest(context, t.model));
  });
}

}  // namespace

bool worsens(const Trial& trial, const FitResult& now, double chance) {
  for (std::size_t r = 0; r < now.misfit.size(); ++r)
    if (trial.misfit[r] > kWorse * now.misfit[r] + chance) return true;
  return false;
}

bool settle(const TrialContext& context, double bound, double needed, std::vector<Trial>& trials) {
  if (std::none_of(trials.begin(), trials.end(),
                   [](const Trial& t) { return t.fate == Fate::fitted; }))
    return false;
  const FitResult& now = context.now;
  const double to_explain = now.cost - bound;
  // Two effects must beat one by more than chance, a law what any force would do, and every value
  // that is fitted what values fit of noise.
  const double of_value = 0.5 * std::log(context.fitter.expected(now.model));
  const auto price = [&](const Trial& t) {
    const bool any = t.model.effects.size() > now.model.effects.size() &&
                     t.model.effects.back().form == LawForm::broadband;
    return t.cost + of_value * fitted_values(t.model) + (t.second ? needed : 0.0) +
           (any ? needed + kOwnPrice * std::max(to_explain, 0.0) : 0.0);
  };
  const auto rank = [&] {
    std::stable_sort(trials.begin(), trials.end(), [&](const Trial& a, const Trial& b) {
      const bool run_a = a.fate == Fate::fitted, run_b = b.fate == Fate::fitted;
      return run_a != run_b ? run_a : price(a) < price(b);
    });
    for (Trial& t : trials) t.fraction = (now.cost - t.cost) / std::max(to_explain, 1e-9);
  };
  rank();
  sharpen(context, bound + needed, trials);
  rank();
  if (trials.front().fraction < kTakesAway) {
    approach(context, trials);
    rank();
  }
  const Trial& best = trials.front();
  // In a component test the place is no question, and real parts follow no law to the end.
  const bool component = context.fitter.plant().equations() == 1;
  const bool most = best.fraction >= (component ? kTakesMost : kTakesAway) ||
                    (best.fraction >= kTakesMost && best.cost - bound < needed);
  return most && now.cost - best.cost > needed && !worsens(best, now, needed);
}

}  // namespace framewatch
