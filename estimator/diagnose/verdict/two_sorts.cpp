#include "estimator/diagnose/verdict/two_sorts.h"

#include <cstddef>
#include <optional>

#include "estimator/diagnose/propose/law_kind.h"
#include "estimator/diagnose/propose/propose.h"
#include "estimator/diagnose/trials/select_trial.h"
#include "estimator/diagnose/trials/trial_names.h"
#include "estimator/diagnose/trials/trials.h"

namespace framewatch::estimator {
namespace {

constexpr std::size_t kOfDeformation = 4, kDissipative = 2;

bool is_dissipative(EffectKind law) {
  return is_of_kind(law, LawKind::dissipative);
}

std::vector<Proposal> of_sort(const TrialContext& c, std::vector<Proposal> all,
                              bool (*wanted)(EffectKind), std::size_t most) {
  std::erase_if(all, [&](const Proposal& p) { return !wanted(p.kind) || is_excluded(c, p.kind); });
  if (all.size() > most) all.resize(most);
  return all;
}

}  // namespace

std::vector<Trial> trials_of_two_sorts(const TrialContext& c, const EffectPlace& element) {
  const std::optional<Localisation> here = localise_element(c.fitter, c.now, element);
  if (!here) return {};
  const std::vector<Proposal> all = propose(c.fitter, *here, 0);
  std::vector<Trial> out =
      try_together(c, *here, of_sort(c, all, is_of_deformation, kOfDeformation),
                   of_sort(c, all, is_dissipative, kDissipative));
  select_trial(c, here->misfit, 0, out);
  std::erase_if(out, [](const Trial& t) { return t.outcome != TrialOutcome::fitted; });
  return out;
}

}  // namespace framewatch::estimator
