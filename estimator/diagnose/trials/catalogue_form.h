#pragma once

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/trials/found_effect.h"

namespace framewatch::estimator {

/// A fitted effect with the catalogue's parameters; times and phases are those of the first
/// segment. A law with another exponent than the catalogue's becomes the catalogue's law with the
/// same force at the largest deformation (velocity).
Effect catalogue_effect(const Plant& plant, const std::vector<RecordSegment>& segments,
                        const FoundEffect& found, const Model& model);
/// Its values alone.
Eigen::VectorXd catalogue_values(const Plant& plant, const std::vector<RecordSegment>& segments,
                                 const FoundEffect& found, const Model& model);

}  // namespace framewatch::estimator
