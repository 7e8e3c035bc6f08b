// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/trials/found_effect.h"
#include "estimator/diagnose/trials/trial.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// Refines a trial, starting from `from`, with the shape of hysteresis free. Returns the trial
/// unchanged if that is not better.
Trial refined(const TrialContext& context, const Trial& trial, const Model& from);

/// Returns a model fitted to the record with the smallest relative misfit. A strongly nonlinear law
/// may converge there where a fit to all records does not.
Model fitted_to_the_weakest(const TrialContext& context, const Model& model);

/// Frees the shapes of all laws (free_shape).
void free_shapes(Model& model);

/// Fits until neither kind of derivative improves the fit. An unfinished fit
/// would appear as one more effect.
FitResult fit_to_the_end(const Fitter& fitter, const Model& model,
                         const std::vector<Eigen::MatrixXcd>& motion);

/// Removes the effects that `now` has beyond the model `before` if refitting without them gives the
/// same cost. After an unfinished fit a redundant effect looks useful. Returns true if they were
/// removed.
bool remove_redundant(const Fitter& fitter, const Model& before, FitResult& now);

/// Returns the mean gap of a model with an effect over that of one without, both fitted by
/// judged_fit().
double gap_ratio(const Fitter& fitter, const Model& with, const Model& without,
                 const Parallel& parallel);

/// Returns true if adding the effect does not reduce the gap of the free run. Each model is fitted
/// by judged_fit(). A spurious effect can improve the equations of a slightly wrong law, but not
/// the free run's motion.
bool is_redundant(const Fitter& fitter, const Model& with, const Model& without,
                  const Parallel& parallel);

/// Takes an effect on an axis' gain or clock out of a model: both are again as declared, within
/// their tolerances.
void hold_axis(const Plant& plant, int axis, Model& model);

/// Returns the model without the effects `first` to `end` - 1 of the list.
Model without_effects(const Model& model, const std::vector<FoundEffect>& effects,
                      std::size_t first, std::size_t end, const Plant& plant);

/// Removes effect i, which the model no longer has, from the list.
void erase_effect(std::size_t i, std::vector<FoundEffect>& effects);

/// Removes every effect without which the others fit as well, those first without which they fit
/// best. An effect that was found beside an unfinished fit, or that only led to a better one, is
/// not needed any more. Keeps at least one effect.
void remove_not_needed(const Fitter& fitter, const Parallel& parallel,
                       std::vector<FoundEffect>& effects, FitResult& now);

/// Removes masses, springs and dampers that the last of the effects makes redundant.
void remove_earlier_redundant(const Fitter& fitter, std::vector<FoundEffect>& effects,
                              FitResult& now);

/// Refits a model with masses, gains and clocks held at their declared values (except those that
/// are effects) and with the exponents of the catalog's laws.
Model declared_model(const Plant& plant, const std::vector<RecordSegment>& segments,
                     const Model& fitted,
                     const std::vector<const std::vector<FoundEffect>*>& effects,
                     const Parallel& within = {});

}  // namespace framewatch::estimator
