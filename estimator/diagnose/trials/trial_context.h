#pragma once

#include <functional>
#include <string>
#include <vector>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/trials/trial.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// What all trials of a round share.
struct TrialContext {
  const Fitter& fitter;
  const FitResult& now;                    ///< the model that is extended
  const std::vector<EffectKind>& without;  ///< excluded names
  const Parallel& parallel;
  std::function<void(const std::string&)> progress;  ///< what is done now
};

/// Whether an effect is an axis' freed gain or clock rather than a member of the model's effects.
bool is_axis_error(EffectKind kind);

void append(std::vector<Trial>& list, std::vector<Trial> more);

/// Expected misfit of the equations that a model's arbitrary signals (broadband forces, clipped
/// axes) remove from the sum.
double removed_misfit(const Fitter& fitter, const Model& model);

}  // namespace framewatch::estimator
