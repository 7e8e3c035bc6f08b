#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "estimator/diagnose/model/model.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// How the trial of a candidate ended.
enum class TrialOutcome {
  fitted,        ///< completely, with free runs
  screened_out,  ///< no free run: others at its place fitted better under the measured motion
  diverged,      ///< its free run diverged
  other_law,     ///< its fitted values are those of another law, or its name is excluded
};

/// A candidate model being fitted: the present model with one effect (or two) added. Only `fitted`
/// trials are ever chosen. The cost of `screened_out` and `diverged` trials is that under the
/// measured motion.
struct Trial {
  TrialOutcome outcome = TrialOutcome::fitted;
  EffectKind kind = EffectKind::cubic_stiffness;
  EffectPlace place;
  double cost = 0;  ///< misfit of the free run over all records, with the prior
  double fraction =
      0;  ///< share of the misfit beyond noise that it explains; NaN: only together with others
  std::vector<double> misfit;  ///< of each record
  Model model;
  /// A second effect that was fitted together with the first.
  std::optional<std::pair<EffectKind, EffectPlace>> second;
  bool sharpened = false, approached = false;  ///< select_trial() refines a trial once in each way
};

}  // namespace framewatch::estimator
