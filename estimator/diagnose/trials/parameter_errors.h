#pragma once

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/trials/found_effect.h"

namespace framewatch::estimator {

/// Sets FoundEffect::std_error: one standard deviation of every parameter of the effects' catalog
/// form, from the curvature of the misfit with everything else free.
void set_errors(const Fitter& fitter, const Model& model,
                const std::vector<Eigen::MatrixXcd>& motion, std::vector<FoundEffect>& effects);

}  // namespace framewatch::estimator
