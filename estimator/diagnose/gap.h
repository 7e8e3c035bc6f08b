#pragma once

#include <Eigen/Core>

#include "estimator/diagnose/whitened.h"

namespace framewatch {

/// How far a model's free run is from the measurement: sqrt(sum |meas - sim|^2 / sum |meas|^2) over
/// the band, and what the sensors' noise alone would make of it.
struct Gap {
  Eigen::VectorXd axis;   ///< base axes: 0
  Eigen::VectorXd floor;  ///< of each axis
  double overall = 0;
  double overall_floor = 0;
  double worst = 0;
  int worst_axis = -1;
  Eigen::MatrixXcd difference;  ///< axes x bins: measured minus simulated
};

/// system: of the model, whitened with Forcing::simulated. Forces of any shape are those that the
/// record needs; a clipped axis is compared with what it would read.
Gap gap_of(const Plant& plant, const Model& model, const Stretch& stretch, const Whitened& system);

}  // namespace framewatch
