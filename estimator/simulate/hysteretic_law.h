// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "estimator/simulate/element_law.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// Returns a spring kh in series with a slider that yields at the deformation dy. N/m, m.
std::unique_ptr<ElementLaw> make_slider(double kh, double dy);

/// Returns the law of bilinear_hysteresis, bouc_wen or pinching. Precondition: problems(effect) is
/// empty.
std::unique_ptr<ElementLaw> make_hysteretic_law(const Effect& e);

}  // namespace framewatch::estimator
