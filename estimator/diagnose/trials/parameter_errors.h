#pragma once

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/trials/found_effect.h"

namespace framewatch::estimator {

/// One standard deviation of every parameter of the catalogue's form of the effects, from the
/// curvature of the misfit with everything else free. Sets FoundEffect::std_error.
void set_errors(const Fitter& fitter, const Model& model,
                const std::vector<Eigen::MatrixXcd>& motion, std::vector<FoundEffect>& effects);

}  // namespace framewatch::estimator
