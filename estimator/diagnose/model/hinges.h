#pragma once

#include <Eigen/Core>

#include "estimator/diagnose/model/model.h"

namespace framewatch::estimator {

/// Returns the moments of rotations per force of the elements: rotations x elements, m. The
/// rotations are of the base (LawForm::rocking), or of every floor of every frame (bending). For
/// bending, each row is scaled by the root of that rotation's flexibility over the one at the base,
/// if the design has bending.
Eigen::MatrixXd hinges(const Plant& plant, const ModelEffect& effect);

/// Change of the elements' stiffness and damping by rotations: elements x elements, to be added to
/// the diagonal matrices.
struct HingedElements {
  Eigen::MatrixXd stiffness, damping;
};
HingedElements hinged_elements(const Plant& plant, const Model& model, const ModelEffect& effect);

}  // namespace framewatch::estimator
