// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "estimator/diagnose/trials/trial.h"

namespace framewatch::estimator {

/// One of several causes that act at once.
struct Cause {
  Trial trial;  ///< as fitted alone
  std::vector<EffectKind>
      like;  ///< names of other causes that reduce the gap nearly as much in its place
};

/// Causes and the model fitted jointly with them; empty if none reduces the gap enough.
struct SeveralCauses {
  std::vector<Cause> causes;  ///< in the order of their members in `model`
  Model model;                ///< of the training records
};

/// Searches for up to three laws that together explain a misfit which no single place explains. Of
/// the tried laws it chooses those that minimize the free run's gap. Every set is fitted to the
/// training records by free_run_fit(); the best sets of each size are extended, so that laws are
/// found that help only together with another. No record's gap may grow, and every cause must
/// reduce the power of the gap by a tenth. tried: models that extend context.now.model by one
/// effect; holdout_from: first record that is held out. Returns an empty result for large
/// buildings.
SeveralCauses several_causes(const TrialContext& context, const std::vector<Trial>& tried,
                             std::size_t holdout_from);

}  // namespace framewatch::estimator
