#pragma once

#include <functional>
#include <vector>

#include "estimator/diagnose/locate/localise.h"
#include "estimator/diagnose/propose/proposal.h"
#include "estimator/diagnose/trials/trial_context.h"

namespace framewatch::estimator {

/// A trial fitted on from a model of its kind, with the shape of hysteresis free; unchanged when
/// that is no better.
Trial sharpened(const TrialContext& context, const Trial& trial, const Model& from);

/// A model fitted to the one record with the smallest relative misfit. A strongly nonlinear law
/// converges there where a fit to all records does not.
Model fitted_to_the_weakest(const TrialContext& context, const Model& model);

/// Frees the shapes of all laws (free_shape).
void free_shapes(Model& model);

/// Fits the laws of each place. wanted: those that are tried by their first names; empty: all.
std::vector<Trial> try_places(const TrialContext& context, const std::vector<Localisation>& places,
                              const std::function<bool(EffectKind)>& wanted = {});

/// Fits effects that are proposed for the present model and its motion.
std::vector<Trial> try_effects(const TrialContext& context, const std::vector<Proposal>& proposals);

/// Fits two laws at the two places of a pair, and of two axes their exchange.
std::vector<Trial> try_pair(const TrialContext& context, const Localisation& pair);

}  // namespace framewatch::estimator
