#pragma once

#include <vector>

#include "estimator/diagnose/diagnosis.h"

namespace framewatch {

/// The fitted model again with masses, gains and clocks as they are declared, but for those that
/// are effects, and exponents as the names of the effects say.
Model declared_model(const Plant& plant, const std::vector<Stretch>& stretches, const Model& fitted,
                     const std::vector<const std::vector<FoundEffect>*>& effects);

}  // namespace framewatch
