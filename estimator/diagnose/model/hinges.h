#pragma once

#include <Eigen/Core>

#include "estimator/diagnose/model/model.h"

namespace framewatch::estimator {

/// Moments of the rotation of the base (LawForm::rocking) or of every floor of every frame
/// (bending) per force of the elements: rotations x elements, m, times the root of a rotation's
/// flexibility over that at the base where the design says it.
Eigen::MatrixXd hinges(const Plant& plant, const ModelEffect& effect);

/// What rotations change of the elements' stiffness and damping: elements x elements, added to the
/// diagonal ones.
struct HingedElements {
  Eigen::MatrixXd stiffness, damping;
};
HingedElements hinged_elements(const Plant& plant, const Model& model, const ModelEffect& effect);

}  // namespace framewatch::estimator
