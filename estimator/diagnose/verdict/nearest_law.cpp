#include "estimator/diagnose/verdict/nearest_law.h"

#include <algorithm>

#include "estimator/diagnose/trials/select_trial.h"
#include "estimator/diagnose/trials/trial_relations.h"

namespace framewatch::estimator {

bool is_of_the_kind_there(const Trial& law, const std::vector<WhereEntry>& where) {
  if (law.place.kind == PlaceKind::whole_frame) return false;
  return std::any_of(where.begin(), where.end(), [&](const WhereEntry& w) {
    return w.kind && same_spot(w.place, law.place) && is_of_kind(law.kind, w.kind->kind);
  });
}

bool nearest_law_first(const TrialContext& context, const std::vector<WhereEntry>& where,
                       std::vector<Trial>& rejected) {
  const auto nearest = std::find_if(rejected.begin(), rejected.end(), [&](const Trial& law) {
    return is_nearest_law(context, law) && is_of_the_kind_there(law, where);
  });
  if (nearest == rejected.end()) return false;
  std::rotate(rejected.begin(), nearest, nearest + 1);
  return true;
}

namespace {

/// Whether it is a force from nowhere, and the likeliest place is an element whose force follows
/// its motion.
bool is_needless_force(const Trial& trial, const std::vector<WhereEntry>& where) {
  const std::vector<ModelEffect>& effects = trial.model.effects;
  if (effects.empty() || effects.back().form != LawForm::broadband || where.empty() ||
      !where.front().kind)
    return false;
  const LawKind kind = where.front().kind->kind;
  return kind != LawKind::external && kind != LawKind::linear;
}

}  // namespace

bool contradicts_the_kind(const Trial& law, const std::vector<WhereEntry>& where) {
  if (is_needless_force(law, where)) return true;
  const auto is = [&](LawKind kind) { return is_of_kind(law.kind, kind); };
  const bool of_deformation = is(LawKind::elastic) || is(LawKind::impact);
  const bool other =
      is(LawKind::dissipative) || is(LawKind::hysteretic) || is(LawKind::time_varying);
  return std::any_of(where.begin(), where.end(), [&](const WhereEntry& w) {
    if (!w.kind || !(w.place == law.place)) return false;
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
