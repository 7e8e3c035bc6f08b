#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/trials/found_effect.h"
#include "estimator/numeric/parallel.h"

namespace framewatch::estimator {

/// Fall of the cost that is worth an effect.
inline constexpr double kMinGain = 50;

inline constexpr int kEndSteps = 6;

/// Until neither kind of derivative improves the fit: an unfinished fit would show up as one more
/// effect. Of kEndSteps each.
FitResult fit_to_the_end(const Fitter& fitter, const Model& model,
                         const std::vector<Eigen::MatrixXcd>& motion);

/// Removes what was added to the model `before` if that, fitted on from here, does as well: after
/// an unfinished fit a needless effect looks useful. Whether it did so.
bool removes_needless(const Fitter& fitter, const Model& before, FitResult& now);

/// Mean gap of a model with an effect over that of one without, both fitted to what is judged.
double gap_ratio(const Fitter& fitter, const Model& with, const Model& without,
                 const Parallel& parallel);

/// Whether the free runs of both models, each fitted to what it is judged by, disagree with the
/// records alike, though one has an effect more: equations that a law leaves a little wrong are met
/// better by effects that are not there, motion is not.
bool takes_nothing(const Fitter& fitter, const Model& with, const Model& without,
                   const Parallel& parallel);

/// Removes masses, springs and dampers that the last of the effects replaces.
void remove_needless_earlier(const Fitter& fitter, std::vector<FoundEffect>& effects,
                             FitResult& now);

}  // namespace framewatch::estimator
