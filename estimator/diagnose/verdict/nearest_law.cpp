// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/nearest_law.h"

#include <algorithm>

#include "estimator/diagnose/trials/select_trial.h"
#include "estimator/diagnose/trials/trial.h"

namespace framewatch::estimator {

namespace {

bool is_of_deformation(LawKind kind) {
  return kind == LawKind::elastic || kind == LawKind::impact;
}

/// Returns the kind of the force needed at the law's place, or null if it is unknown.
const KindOfLaw* known_there(const Trial& law, const std::vector<WhereEntry>& where) {
  if (law.place.kind == PlaceKind::whole_frame) return nullptr;
  const auto there = std::find_if(where.begin(), where.end(), [&](const WhereEntry& w) {
    return w.kind && same_spot(w.place, law.place);
  });
  return there == where.end() ? nullptr : &*there->kind;
}

/// Returns true if a law leaves far less than general functions of the motion. Friction that sticks
/// is not such a function: it is the force that holds.
bool is_better_than_its_kind(const SearchSettings& settings, const Trial& law,
                             const KindOfLaw& known) {
  const double best = *std::max_element(known.share.begin(), known.share.end());
  return 1 - law.fraction < settings.kind_leaves * (1 - best);
}

}  // namespace

bool is_of_the_kind_there(const SearchSettings& settings, const Trial& law,
                          const std::vector<WhereEntry>& where) {
  const KindOfLaw* known = known_there(law, where);
  return known &&
         (is_of_kind(law.kind, known->kind) || is_better_than_its_kind(settings, law, *known) ||
          (is_of_deformation(known->kind) && is_of_deformation(law.kind)));
}

bool nearest_law_first(const TrialContext& context, const std::vector<WhereEntry>& where,
                       std::vector<Trial>& rejected) {
  const auto nearest = std::find_if(rejected.begin(), rejected.end(), [&](const Trial& law) {
    const KindOfLaw* known = known_there(law, where);
    return known &&
           (is_of_kind(law.kind, known->kind) ||
            is_better_than_its_kind(context.settings(), law, *known)) &&
           is_nearest_law(context, law);
  });
  if (nearest == rejected.end()) return false;
  std::rotate(rejected.begin(), nearest, nearest + 1);
  return true;
}

namespace {

/// Returns true if the trial is an arbitrary force although the likeliest place is an element whose
/// force follows its motion.
bool is_redundant_force(const Trial& trial, const std::vector<WhereEntry>& where) {
  const std::vector<ModelEffect>& effects = trial.model.effects;
  if (effects.empty() || effects.back().form != LawForm::broadband || where.empty() ||
      !where.front().kind)
    return false;
  const LawKind kind = where.front().kind->kind;
  return kind != LawKind::external && kind != LawKind::linear;
}

}  // namespace

bool contradicts_the_kind(const SearchSettings& settings, const Trial& law,
                          const std::vector<WhereEntry>& where, double left) {
  if (is_redundant_force(law, where)) return true;
  const auto is = [&](LawKind kind) { return is_of_kind(law.kind, kind); };
  const bool of_deformation = is_of_deformation(law.kind);
  const bool other =
      is(LawKind::dissipative) || is(LawKind::hysteretic) || is(LawKind::time_varying);
  return std::any_of(where.begin(), where.end(), [&](const WhereEntry& w) {
    if (!w.kind || !(w.place == law.place)) return false;
    const double share = w.kind->share[static_cast<std::size_t>(w.kind->kind)];
    if (left < settings.kind_leaves * (1 - share)) return false;
    switch (w.kind->kind) {
      case LawKind::elastic:
      case LawKind::impact:
        return other && !of_deformation;
      case LawKind::dissipative:
      case LawKind::hysteretic:
      case LawKind::time_varying:
        return (of_deformation || other) && !is(w.kind->kind);
      case LawKind::linear:
      case LawKind::external:
        break;
    }
    return false;
  });
}

}  // namespace framewatch::estimator
