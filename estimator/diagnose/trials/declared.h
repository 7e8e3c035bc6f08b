#pragma once

#include <vector>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/trials/found_effect.h"

namespace framewatch::estimator {

/// Refits a model with masses, gains and clocks held at their declared values (except those that
/// are effects) and with the exponents of the catalog's laws.
Model declared_model(const Plant& plant, const std::vector<RecordSegment>& segments,
                     const Model& fitted,
                     const std::vector<const std::vector<FoundEffect>*>& effects,
                     const Parallel& within = {});

}  // namespace framewatch::estimator
