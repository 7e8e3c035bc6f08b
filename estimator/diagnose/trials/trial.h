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
  screened_out,  ///< no free run: others of its place fitted better under the measured motion
  diverged,      ///< its free run diverged
  other_law,     ///< its fitted values are those of another law, or its name is excluded
};

/// A candidate effect (or two) and its fit. Only `fitted` ones are ever chosen; the cost of
/// `screened_out` and `diverged` is that under the measured motion.
struct Trial {
  TrialOutcome outcome = TrialOutcome::fitted;
  EffectKind kind = EffectKind::cubic_stiffness;
  EffectPlace place;
  double cost = 0;      ///< misfit of the free run over all records, with the prior
  double fraction = 0;  ///< of the misfit beyond noise that it explains; NaN: beside others only
  std::vector<double> misfit;  ///< of each record
  Model model;
  /// A second effect that was fitted together with it.
  std::optional<std::pair<EffectKind, EffectPlace>> second;
  bool sharpened = false, approached = false;  ///< select_trial() fits it so once
};

}  // namespace framewatch::estimator
