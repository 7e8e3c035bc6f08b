#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/model.h"

namespace framewatch::estimator {

/// Where a law meets the building: one deformation, and the force against it. A law of a whole
/// frame or building has one for every element of it.
struct LawPort {
  Eigen::VectorXd act;       ///< force on the equations per newton; deformation of displacements
  Eigen::RowVectorXd sense;  ///< over the axes: their motion to the deformation's
  int element = -1;          ///< in theta, where it is an element
  double scale = 1;          ///< of the law's force here (LawValues::scale)
};

/// The ports of an element law. Between floors (node_pair): of the upper relative to the lower one,
/// to_story 0 the ground. Of several elements the force is in proportion to their stiffness in
/// `model`, one to their mean.
std::vector<LawPort> law_ports(const Plant& plant, const Model& model, const ModelEffect& effect);

/// A port of a model's element laws, in the order of the effects.
struct ActiveLaw {
  std::size_t effect = 0;
  LawPort port;
};

std::vector<ActiveLaw> active_laws(const Plant& plant, const Model& model);

/// The law's values at a port in one record.
LawValues law_at(const Model& model, const ActiveLaw& active, std::size_t record);

}  // namespace framewatch::estimator
