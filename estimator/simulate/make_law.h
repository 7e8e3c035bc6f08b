#pragma once

#include <memory>

#include "estimator/simulate/element_law.h"
#include "estimator/structure/effect.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// amplitude_dependence of one of its elements. stiffness: of that, N/m.
std::unique_ptr<ElementLaw> make_amplitude_law(const Effect& effect, double stiffness);

/// Null when the effect is not a law of one deformation. The effect must be without problems.
std::unique_ptr<ElementLaw> make_law(const Effect& effect, const Structure& structure);

}  // namespace framewatch::estimator
