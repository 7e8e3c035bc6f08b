#pragma once

#include <cstddef>
#include <vector>

#include "estimator/diagnose/trials/trial_context.h"

namespace framewatch::estimator {

/// One of several causes that act at once.
struct Cause {
  Trial trial;                   ///< fitted alone, as it was tried
  std::vector<EffectKind> like;  ///< that take nearly as much in its stead
};

/// Causes, fitted together to what they are judged by; empty where none take enough of the gap.
struct SeveralCauses {
  std::vector<Cause> causes;  ///< in the order of their members in `model`
  Model model;                ///< of the training records
};

/// Where no place explains the misfit alone: of the laws that were tried, those that together make
/// the free run of the held-out records differ least, up to three. Every set is fitted to the
/// training records as it is judged (judged_fit); sets that are best of their size lead to larger
/// ones, so that a law is found that helps only beside another. No record's gap may grow, and
/// every cause must take a tenth of the gap beside the others.
/// tried: models that extend context.now.model by one effect; holdout_from: first record that is
/// held out.
SeveralCauses several_causes(const TrialContext& context, const std::vector<Trial>& tried,
                             std::size_t holdout_from);

}  // namespace framewatch::estimator
