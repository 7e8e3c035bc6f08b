// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/round_trials.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "estimator/diagnose/propose/contact_proposals.h"
#include "estimator/diagnose/trials/trial_names.h"

namespace framewatch::estimator {
namespace {

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

/// Adds moments at the base. Bending frames rotate at every floor, and if some floors are not read,
/// a force at the top explains more of that than a moment at the base.
void add_moments(const std::vector<Localisation>& all, std::vector<Localisation>& places) {
  const auto is_moment = [](const Localisation& place) {
    return place.candidate_places.front().kind == CandidatePlace::Kind::rocking;
  };
  if (std::any_of(places.begin(), places.end(), is_moment)) return;
  std::copy_if(all.begin(), all.end(), std::back_inserter(places), is_moment);
}

/// Returns the elements on which an earlier law acts.
std::vector<CandidatePlace> places_of_law(const Located& located, const EffectPlace& law,
                                          const Structure& structure) {
  std::vector<CandidatePlace> out;
  for (const Localisation& l : located.once) {
    const CandidatePlace& one = l.candidate_places.front();
    if (one.kind != CandidatePlace::Kind::element) continue;
    const int frame = one.place.frame;
    const bool of_frame = law.kind == PlaceKind::whole_frame && frame == law.frame;
    const bool of_building = law.kind == PlaceKind::building && frame >= 0 &&
                             structure.direction(frame) == law.direction;
    if (one.place == law || of_frame || of_building) out.push_back(one);
  }
  return out;
}

/// Localizes with arbitrary signals at the elements of that law.
Localisation localise_law(const TrialContext& context, const Located& located,
                          const std::vector<CandidatePlace>& own) {
  for (const Localisation& l : located.places)
    if (own.size() == 1 && l.candidate_places.front().place == own.front().place) return l;
  return localise(context.fitter, context.now.model, context.now.motion, own,
                  context.settings().steps);
}

}  // namespace

bool is_element(const Localisation& place) {
  return place.candidate_places.front().kind == CandidatePlace::Kind::element;
}

bool leaves_less(const std::vector<Trial>& trials, double bound) {
  return std::any_of(trials.begin(), trials.end(), [bound](const Trial& t) {
    return t.outcome == TrialOutcome::fitted && t.cost < bound;
  });
}

double bound_of(const Plant& plant, const Localisation& places) {
  const auto equations = static_cast<double>(plant.read_equations());
  double unseen = 0;
  for (const CandidatePlace& s : places.candidate_places) unseen += static_cast<double>(s.size());
  return places.misfit * equations / std::max(equations - unseen, 1.0);
}

void relocate_beside(const TrialContext& context, const std::vector<FoundEffect>& found,
                     Located& located) {
  if (located.places.empty()) return;
  const double chance = chance_of(context.fitter, context.now.model);
  const double least = located.places.front().ratio - 1;
  const bool best_of_law = std::any_of(found.begin(), found.end(), [&](const FoundEffect& e) {
    return e.chosen.place == located.places.front().candidate_places.front().place &&
           is_element(located.places.front());
  });
  if (best_of_law && least < chance) return;
  for (const FoundEffect& e : found) {
    if (e.index < 0 || !context.now.model.effects[at(e.index)].element_law()) continue;
    const std::vector<CandidatePlace> own =
        places_of_law(located, e.chosen.place, context.fitter.plant().structure);
    if (own.empty()) continue;
    const Localisation law = localise_law(context, located, own);
    if (law.ratio - 1 > context.settings().as_likely * std::max(least, chance) + chance) continue;
    if (own.size() == 1 && law.ratio > 1 + chance) {
      std::vector<Localisation> beside =
          locate_beside(context.fitter, context.now, located.once, own.front(), context.parallel);
      if (!beside.empty() &&
          beside.front().ratio - 1 < context.settings().pair_leaves * (law.ratio - 1)) {
        located.places = std::move(beside);
        return;
      }
    }
    if (!best_of_law) located.places.clear();
    return;
  }
}

std::vector<Trial> trials_of_places(const TrialContext& context, const Located& located,
                                    bool small) {
  std::vector<Localisation> places = contenders(context.settings(), located.places);
  if (small) std::erase_if(places, is_element);
  const std::vector<Localisation> more =
      as_likely(context.fitter, context.now, located, context.parallel);
  places.insert(places.end(), more.begin(), more.end());
  if (context.fitter.plant().unread.cols() > 0) add_moments(located.places, places);
  return try_places(context, places);
}

std::vector<Trial> trials_of_whole_frame(const TrialContext& context, const Located& located,
                                         int frame) {
  const auto place = std::find_if(located.places.begin(), located.places.end(), [&](const auto& p) {
    const int own = p.candidate_places.front().place.frame;
    return own >= 0 && (frame < 0 || own == frame);
  });
  if (place == located.places.end() || context.fitter.plant().structure.stories < 2 ||
      is_excluded(context, EffectKind::amplitude_dependence))
    return {};
  EffectPlace whole;
  whole.kind = PlaceKind::whole_frame;
  whole.frame = place->candidate_places.front().place.frame;
  const Structure& structure = context.fitter.plant().structure;
  const bool along_x = structure.direction(whole.frame) == Direction::x;
  if ((along_x ? structure.n() : structure.m()) < 2)
    return {};  // then it equals the law of the building
  return try_effects(context, amplitude_proposals(context.fitter, *place, whole));
}

std::vector<Trial> trials_of_pairs(const TrialContext& context, const Located& located,
                                   double needed, double& bound) {
  context.progress("pairs of places");
  const Localisation& best = located.places.front();
  const std::vector<Localisation> pairs =
      locate_pairs(context.fitter, context.now, located.once, context.parallel);
  const double limit = best.ratio > context.settings().one_place
                           ? 1 + context.settings().pair_leaves * (best.ratio - 1)
                           : context.settings().one_place;
  std::vector<Trial> out;
  if (pairs.empty() || pairs.front().ratio >= limit) return out;
  bound = std::min(context.now.cost, bound_of(context.fitter.plant(), pairs.front()));
  for (std::size_t i = 0; i < std::min<std::size_t>(2, pairs.size()); ++i) {
    if (pairs[i].ratio > 2 * pairs.front().ratio) break;
    if (leaves_less(out, bound_of(context.fitter.plant(), pairs[i]) - needed)) break;
    append(out, try_pair(context, pairs[i]));
  }
  return out;
}

}  // namespace framewatch::estimator
