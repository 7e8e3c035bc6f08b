// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "estimator/diagnose/locate/localise.h"
#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/diagnose/trials/trial.h"

namespace framewatch::estimator {

/// Fits the laws of each place. wanted: which first names to try; empty: all.
std::vector<Trial> try_places(const TrialContext& context, const std::vector<Localisation>& places,
                              const std::function<bool(EffectKind)>& wanted = {});

/// Fits effects that are proposed for the present model and its motion.
std::vector<Trial> try_effects(const TrialContext& context, const std::vector<Proposal>& proposals);

/// Fits two laws at the two places of a pair. For two axes it also fits their exchange.
std::vector<Trial> try_pair(const TrialContext& context, const Localisation& pair);

/// Fits every law of the first list with every law of the second, all at one place.
std::vector<Trial> try_together(const TrialContext& context, const Localisation& place,
                                const std::vector<Proposal>& first,
                                const std::vector<Proposal>& second);

}  // namespace framewatch::estimator
