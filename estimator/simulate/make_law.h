// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "estimator/simulate/element_law.h"
#include "estimator/structure/effect.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Returns amplitude_dependence of one element. stiffness: of the element, N/m.
std::unique_ptr<ElementLaw> make_amplitude_law(const Effect& effect, double stiffness);

/// Returns the law of an effect; null when the effect does not act on one deformation.
/// Precondition: problems(effect) is empty.
std::unique_ptr<ElementLaw> make_law(const Effect& effect, const Structure& structure);

}  // namespace framewatch::estimator
