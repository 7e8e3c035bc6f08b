#pragma once

#include <memory>

#include "estimator/simulate/element_law.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// Of bilinear_hysteresis, bouc_wen and pinching.
std::unique_ptr<ElementLaw> make_hysteretic_law(const Effect& effect);

/// A spring kh in series with a slider that gives way at the deformation dy.
std::unique_ptr<ElementLaw> make_slider(double kh, double dy);

}  // namespace framewatch::estimator
