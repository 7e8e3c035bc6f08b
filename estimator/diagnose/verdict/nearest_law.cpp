#include "estimator/diagnose/verdict/nearest_law.h"

#include <algorithm>

#include "estimator/diagnose/trials/select_trial.h"
#include "estimator/diagnose/trials/trial_relations.h"

namespace framewatch::estimator {

bool nearest_law_first(const TrialContext& context, const std::vector<WhereEntry>& where,
                       std::vector<Trial>& rejected) {
  const auto is_of_the_kind_there = [&](const Trial& law) {
    return std::any_of(where.begin(), where.end(), [&](const WhereEntry& w) {
      return w.kind && same_spot(w.place, law.place) && is_of_kind(law.kind, w.kind->kind);
    });
  };
  const auto nearest = std::find_if(rejected.begin(), rejected.end(), [&](const Trial& law) {
    return is_nearest_law(context, law) && is_of_the_kind_there(law);
  });
  if (nearest == rejected.end()) return false;
  std::rotate(rejected.begin(), nearest, nearest + 1);
  return true;
}

}  // namespace framewatch::estimator
