#include "estimator/diagnose/strange_masses.h"

#include <algorithm>

namespace framewatch {
namespace {

constexpr double kDoesAway = 0.9;  ///< of what is strange
constexpr double kAsWell = 0.8;    ///< of the best one's gain, which leaves open what it is
constexpr double kBeyond = 2;      ///< standard deviations of a frame's mass

/// A mass within what is tolerated of both its frames' is none that is missing.
bool is_tolerated(const Structure& s, const ModelEffect& effect, double sigma) {
  if (effect.form != LawForm::mass) return false;
  const std::vector<int> frames = frames_at(s, effect.place.crossing);
  return std::all_of(frames.begin(), frames.end(), [&](int frame) {
    return effect.knobs[0].plain() < kBeyond * sigma * s.frame_mass(effect.place.story, frame);
  });
}

/// Where a linear effect that is no element's stiffness or damping may act.
bool is_linear_place(const Suspect& s) {
  return s.kind == Suspect::Kind::crossing || s.kind == Suspect::Kind::link ||
         s.kind == Suspect::Kind::rocking || (s.kind == Suspect::Kind::node && s.place.story >= 2);
}

}  // namespace

std::vector<Trial> strange_masses(const TrialContext& context, const Located& located) {
  const Model& model = context.now.model;
  const double sigma = context.fitter.tolerances().mass;
  if (sigma <= 0) return {};
  const double by_chance = 0.5 * static_cast<double>(model.mass_change.size());
  const double strange = 0.5 * (model.mass_change / sigma).squaredNorm() - by_chance;
  if (strange < kStrangeMasses) return {};
  std::vector<Localisation> places;
  for (const Localisation& l : located.once) {
    if (!is_linear_place(l.suspects.front())) continue;
    places.push_back(l);
    places.back().model = model;
    places.back().motion = context.now.motion;
  }
  std::vector<EffectKind> without = context.without;
  without.insert(without.end(), {EffectKind::tuned_mass_damper, EffectKind::unmeasured_force});
  const TrialContext linear{context.fitter, context.now, without, context.parallel,
                            context.progress};
  std::vector<Trial> out = try_places(linear, places);
  std::erase_if(out, [&](const Trial& t) {
    return t.fate != Fate::fitted ||
           context.now.cost - t.cost < std::max(kStrangeMasses, kDoesAway * strange) ||
           !(t.model.effects.back().knobs[0].plain() > 0) ||
           is_tolerated(context.fitter.plant().structure, t.model.effects.back(), sigma);
  });
  for (Trial& t : out) t.fraction = std::min(1.0, (context.now.cost - t.cost) / strange);
  std::stable_sort(out.begin(), out.end(),
                   [](const Trial& a, const Trial& b) { return a.cost < b.cost; });
  if (out.size() > 1 && context.now.cost - out[1].cost > kAsWell * (context.now.cost - out[0].cost))
    return {};
  return out;
}

}  // namespace framewatch
