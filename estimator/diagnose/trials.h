#pragma once

#include <vector>

#include "estimator/diagnose/diagnosis.h"

namespace framewatch {

/// Everything a trial needs to know.
struct TrialContext {
  const Fitter& fitter;
  const FitResult& now;                    ///< the model that is to be extended
  const std::vector<EffectKind>& without;  ///< names that are not tried
  const Parallel& parallel;
  std::function<void(const std::string&, double)> progress;  ///< share of this step
};

/// Whether an effect is an axis' freed gain or clock rather than a member of the model's effects.
bool is_axis_error(EffectKind kind);

void append(std::vector<Trial>& list, std::vector<Trial> more);

/// Misfit that a model is spared because it does not look at what may be anything.
double spared(const Fitter& fitter, const Model& model);

/// The same fitted on from a model of its kind, with the shape of hysteresis free; as it was when
/// that is no better.
Trial sharpened(const TrialContext& context, const Trial& trial, const Model& from);

/// A model fitted to the one record that shows least of what is missing: a law that bends the
/// motion strongly finds its way there, where all records together have none.
Model fitted_to_the_weakest(const TrialContext& context, const Model& model);

/// Lets the exponent and the unloading of round hysteresis move in a fit.
void free_shapes(Model& model);

/// The laws of each place, fitted to the end.
std::vector<Trial> try_places(const TrialContext& context, const std::vector<Localisation>& places);

/// Two laws at the two places of a pair, or their readings exchanged.
std::vector<Trial> try_pair(const TrialContext& context, const Localisation& pair);

}  // namespace framewatch
