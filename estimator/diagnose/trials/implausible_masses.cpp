// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/implausible_masses.h"

#include <algorithm>
#include <cstddef>

#include "estimator/diagnose/propose/propose.h"
#include "estimator/diagnose/trials/linear_gains.h"
#include "estimator/diagnose/trials/trial_names.h"

namespace framewatch::estimator {
namespace {

constexpr std::size_t kMaxPlaces = 64;  ///< of a large building, likeliest first

/// Returns true if an extra mass lies within the tolerance of the masses of all its frames.
bool is_tolerated(const Structure& s, const ModelEffect& effect, double most) {
  if (effect.form != LawForm::mass) return false;
  const std::vector<int> frames = frames_at(s, effect.place.crossing);
  return std::all_of(frames.begin(), frames.end(), [&](int frame) {
    return effect.parameters[0].plain() < most * s.frame_mass(effect.place.story, frame);
  });
}

/// Returns the linear effects that gain enough in one step of the fit, best first. located: the
/// places to try.
std::vector<Proposal> promising(const TrialContext& context, const Located& located,
                                double needed) {
  const Plant& plant = context.fitter.plant();
  std::vector<Proposal> all;
  std::size_t places = 0;
  for (Localisation place : located.once) {
    if (plant.is_large() && places == kMaxPlaces) break;
    place.model = context.now.model;
    const std::vector<Proposal> here = propose_linear(plant, place);
    places += !here.empty();
    for (const Proposal& p : here)
      if (!is_excluded(context, p.kind)) all.push_back(p);
  }
  std::vector<ModelEffect> effects;
  for (const Proposal& p : all) effects.push_back(p.model.effects.back());
  const std::vector<LinearGain> gains = linear_gains(context, effects);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (gains[i].value > 0 && gains[i].cost > context.settings().promised_by_step * needed)
      order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return gains[a].cost > gains[b].cost; });
  if (order.size() > context.settings().linear_effects)
    order.resize(context.settings().linear_effects);
  std::vector<Proposal> out;
  for (const std::size_t i : order) {
    all[i].model.effects.back().parameters.front().value = gains[i].value;
    out.push_back(all[i]);
  }
  return out;
}

}  // namespace

std::vector<Trial> implausible_masses(const TrialContext& context, const Located& located) {
  const Model& model = context.now.model;
  const SearchSettings& settings = context.settings();
  const double sigma = context.fitter.tolerances().mass;
  if (sigma <= 0) return {};
  const double by_chance = 0.5 * static_cast<double>(model.mass_change.size());
  const double excess = 0.5 * (model.mass_change / sigma).squaredNorm() - by_chance;
  if (excess < settings.implausible_masses) return {};
  const double needed = std::max(settings.implausible_masses, settings.explains_most * excess);
  std::vector<Trial> out = try_effects(context, promising(context, located, needed));
  std::erase_if(out, [&](const Trial& t) {
    return t.outcome != TrialOutcome::fitted || context.now.cost - t.cost < needed ||
           !(t.model.effects.back().parameters[0].plain() > 0) ||
           is_tolerated(context.fitter.plant().structure, t.model.effects.back(),
                        settings.mass_std * sigma);
  });
  for (Trial& t : out) t.fraction = std::min(1.0, (context.now.cost - t.cost) / excess);
  std::stable_sort(out.begin(), out.end(),
                   [](const Trial& a, const Trial& b) { return a.cost < b.cost; });
  if (out.size() > 1 &&
      context.now.cost - out[1].cost > settings.explains_much * (context.now.cost - out[0].cost))
    return {};
  return out;
}

}  // namespace framewatch::estimator
