#include "estimator/diagnose/trials/implausible_masses.h"

#include <algorithm>

namespace framewatch::estimator {
namespace {

constexpr double kExplained = 0.9;  ///< of the masses' excess cost, by one effect
constexpr double kAsWell = 0.8;     ///< of the best one's gain: the effect remains ambiguous
constexpr double kBeyond = 2;       ///< standard deviations of a frame's mass

/// Whether an extra mass lies within the tolerance of the masses of all its frames.
bool is_tolerated(const Structure& s, const ModelEffect& effect, double sigma) {
  if (effect.form != LawForm::mass) return false;
  const std::vector<int> frames = frames_at(s, effect.place.crossing);
  return std::all_of(frames.begin(), frames.end(), [&](int frame) {
    return effect.parameters[0].plain() < kBeyond * sigma * s.frame_mass(effect.place.story, frame);
  });
}

/// Whether a linear effect other than an element's stiffness or damping may act there.
bool is_linear_place(const CandidatePlace& s) {
  return s.kind == CandidatePlace::Kind::crossing || s.kind == CandidatePlace::Kind::link ||
         s.kind == CandidatePlace::Kind::rocking ||
         (s.kind == CandidatePlace::Kind::node && s.place.story >= 2);
}

}  // namespace

std::vector<Trial> implausible_masses(const TrialContext& context, const Located& located) {
  const Model& model = context.now.model;
  const double sigma = context.fitter.tolerances().mass;
  if (sigma <= 0) return {};
  const double by_chance = 0.5 * static_cast<double>(model.mass_change.size());
  const double excess = 0.5 * (model.mass_change / sigma).squaredNorm() - by_chance;
  if (excess < kImplausibleMasses) return {};
  std::vector<Localisation> places;
  for (const Localisation& l : located.once) {
    if (!is_linear_place(l.candidate_places.front())) continue;
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
    return t.outcome != TrialOutcome::fitted ||
           context.now.cost - t.cost < std::max(kImplausibleMasses, kExplained * excess) ||
           !(t.model.effects.back().parameters[0].plain() > 0) ||
           is_tolerated(context.fitter.plant().structure, t.model.effects.back(), sigma);
  });
  for (Trial& t : out) t.fraction = std::min(1.0, (context.now.cost - t.cost) / excess);
  std::stable_sort(out.begin(), out.end(),
                   [](const Trial& a, const Trial& b) { return a.cost < b.cost; });
  if (out.size() > 1 && context.now.cost - out[1].cost > kAsWell * (context.now.cost - out[0].cost))
    return {};
  return out;
}

}  // namespace framewatch::estimator
