// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/model.h"

namespace framewatch::estimator {

/// Connection of a law to the building: one deformation, and the force against it. A law of a whole
/// frame or building has a port at every element.
struct LawPort {
  Eigen::VectorXd act;       ///< force on the equations per newton; deformation per displacement
  Eigen::RowVectorXd sense;  ///< over the axes: deformation per motion of the axes
  int element = -1;          ///< in theta; -1: not an element
  double scale = 1;          ///< of the law's force here (LawValues::scale)
};

/// Returns the ports of an element law. A law between floors (node_pair) acts on the upper relative
/// to the lower floor; to_story 0 is the ground. For several elements, the force is proportional to
/// their stiffness in `model`, with mean scale 1.
std::vector<LawPort> law_ports(const Plant& plant, const Model& model, const ModelEffect& effect);

/// A port of a model's element laws, in the order of the effects.
struct ActiveLaw {
  std::size_t effect = 0;
  LawPort port;
};

std::vector<ActiveLaw> active_laws(const Plant& plant, const Model& model);

/// Returns the law's values at a port in one record.
LawValues law_at(const Model& model, const ActiveLaw& active, std::size_t record);

}  // namespace framewatch::estimator
