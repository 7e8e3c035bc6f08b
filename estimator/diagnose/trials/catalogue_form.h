// SPDX-License-Identifier: MIT
#pragma once

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/trials/found_effect.h"

namespace framewatch::estimator {

/// Returns a fitted effect with the catalog's parameters. Times and phases are those of the first
/// segment. A law with another exponent than the catalog's becomes the catalog's law with the same
/// force at the largest deformation (velocity).
Effect catalogue_effect(const Plant& plant, const std::vector<RecordSegment>& segments,
                        const FoundEffect& found, const Model& model);
/// Returns only its values.
Eigen::VectorXd catalogue_values(const Plant& plant, const std::vector<RecordSegment>& segments,
                                 const FoundEffect& found, const Model& model);

/// Sets FoundEffect::std_error: one standard deviation of every parameter of the effects' catalog
/// form, from the curvature of the misfit with everything else free.
void set_errors(const Fitter& fitter, const Model& model,
                const std::vector<Eigen::MatrixXcd>& motion, std::vector<FoundEffect>& effects);

}  // namespace framewatch::estimator
