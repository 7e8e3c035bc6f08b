#pragma once

#include <Eigen/Core>

#include "estimator/diagnose/fit/whitened.h"

namespace framewatch::estimator {

/// Disagreement of a model's free run and the measurement: NRMSE, sqrt(sum |meas - sim|^2 / sum
/// |meas|^2) over the band, and the value that the sensors' noise alone would give (floor).
struct Gap {
  Eigen::VectorXd axis;   ///< base axes: 0
  Eigen::VectorXd floor;  ///< of each axis
  double overall = 0;
  double overall_floor = 0;
  double worst = 0;
  int worst_axis = -1;
  Eigen::MatrixXcd difference;  ///< axes x bins: measured minus simulated
};

/// system: of the model, whitened with Forcing::simulated. Arbitrary forces (LawForm::broadband)
/// are estimated from the record; a clipped axis is compared with the clipped simulation.
Gap gap_of(const Plant& plant, const Model& model, const RecordSegment& segment,
           const Whitened& system);

}  // namespace framewatch::estimator
