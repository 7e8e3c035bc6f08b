#pragma once

#include <vector>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/fit/gap.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// Gap of a model's free run of each segment; segments whose run diverges are left out.
std::vector<Gap> gaps_of(const Fitter& fitter, const Model& model);

/// Root mean square of the gaps of all segments; infinite where a run diverges.
double rms_gap(const Fitter& fitter, const Model& model);

/// A model fitted to what it is judged by, the free run at the outputs (Gap).
struct JudgedFit {
  Model model;
  double gap = 0;  ///< rms_gap()
  /// The misfit is near that of noise: fitted with the sensors' noise alone. Otherwise with the
  /// model's error in the weights (with_model_error), as large as the gap.
  bool near_noise = false;
};

/// From several starts, the first of which is fitted under the sensors' noise alone too; the best
/// by its gap. Where the model's error is in the weights, ratios of the modes
/// (LawForm::modal_damping) are freed that lower the gap clearly.
/// steps: of each fit. Where nothing can be fitted, the first start.
JudgedFit judged_fit(const Fitter& fitter, const std::vector<Model>& starts, int steps,
                     const Parallel& parallel = {});

/// The best by its gap of the free runs fitted from each of the starts, with the model's error in
/// the weights: once, `steps` long, or until the gap falls no more.
JudgedFit free_run_fit(const Fitter& fitter, const std::vector<Model>& starts, int steps,
                       bool to_the_end);

/// Starts of the linear class beside a model of it: with the design's damping where it has less,
/// and the design itself.
std::vector<Model> linear_starts(const Plant& plant, const Model& model);

}  // namespace framewatch::estimator
