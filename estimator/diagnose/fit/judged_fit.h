// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/fit/gap.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// Returns the gap of a model's free run of each segment. Leaves out segments whose run diverges.
std::vector<Gap> gaps_of(const Fitter& fitter, const Model& model);

/// Returns the root mean square of the gaps of all segments; infinite if a run diverges.
double rms_gap(const Fitter& fitter, const Model& model);

/// A model fitted by the criterion that judges it: the gap of its free run.
struct JudgedFit {
  Model model;
  double gap = 0;  ///< rms_gap()
  /// True if the misfit is near that of noise. The model is then fitted with the sensors' noise
  /// alone, otherwise with a model error as large as the gap in the weights (with_model_error).
  bool near_noise = false;
};

/// Fits from several starts and returns the result with the smallest gap. Fits the first start
/// under the sensors' noise alone too. If the weights contain the model's error, frees modal
/// damping ratios (LawForm::modal_damping) that lower the gap clearly. steps: of each fit. Returns
/// the first start if nothing can be fitted.
JudgedFit judged_fit(const Fitter& fitter, const std::vector<Model>& starts, int steps,
                     const Parallel& parallel = {});

/// Fits the free run from each start with the model's error in the weights, and returns the result
/// with the smallest gap. to_the_end: repeat fits of `steps` until the gap no longer falls;
/// otherwise fit once.
JudgedFit free_run_fit(const Fitter& fitter, const std::vector<Model>& starts, int steps,
                       bool to_the_end);

/// Returns starts for a linear model: the model itself, the model with at least the design's
/// damping, and the design.
std::vector<Model> linear_starts(const Plant& plant, const Model& model);

}  // namespace framewatch::estimator
