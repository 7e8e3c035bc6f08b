#pragma once

#include "estimator/diagnose/diagnosis.h"

namespace framewatch {

/// A fitted effect in the catalogue's terms; times and phases are those of the first stretch.
/// Powers between the catalogue's are given as the catalogue's law with the same force at the
/// largest deformation (velocity) seen.
Effect catalogue_effect(const Plant& plant, const std::vector<Stretch>& stretches,
                        const FoundEffect& found, const Model& model);
/// Its values alone.
Eigen::VectorXd catalogue_values(const Plant& plant, const std::vector<Stretch>& stretches,
                                 const FoundEffect& found, const Model& model);

}  // namespace framewatch
