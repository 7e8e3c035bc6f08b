#pragma once

#include <functional>
#include <string>
#include <vector>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/trials/trial.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// Shared by all trials of a round.
struct TrialContext {
  const Fitter& fitter;
  const FitResult& now;                    ///< the model that is extended
  const std::vector<EffectKind>& without;  ///< excluded names
  const Parallel& parallel;
  std::function<void(const std::string&)>
      progress;  ///< called with a description of the current work
};

/// Returns true if an effect is an axis' freed gain or clock instead of one of the model's effects.
bool is_axis_error(EffectKind kind);

void append(std::vector<Trial>& list, std::vector<Trial> more);

/// Returns the expected misfit of the equations that a model's arbitrary signals (broadband forces,
/// clipped axes) remove from the sum.
double removed_misfit(const Fitter& fitter, const Model& model);

}  // namespace framewatch::estimator
