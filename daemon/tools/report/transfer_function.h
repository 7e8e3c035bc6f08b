#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "daemon/tools/report/session_motion.h"

namespace framewatch::daemon {

/// Acceleration of a direction's frames at the top floor, their mean, over that of the base along
/// the same direction: cross spectrum over the base's spectrum (H1), Hann segments that overlap by
/// half. `model` is the same quotient for the model driven by the same base motion.
struct TransferFunction {
  estimator::Direction direction;
  int segments = 0;
  std::vector<double> frequency_hz;
  std::vector<double> measured;   ///< absolute value, 1
  std::vector<double> coherence;  ///< 0..1
  std::vector<double> model;      ///< empty without reference values, or over 100 unknowns
  /// The lowest peak of the model's motion along the direction, and the measured peak whose shape
  /// along it is most like that one's (MAC), at 0.6 to 1.6 times its frequency; NaN: none is alike.
  double measured_mode_hz = 0, model_mode_hz = 0;
  double mac = 0;  ///< of the two shapes, weighted by mass: 1 is the same; NaN: no pair

  /// (measured over model)^2: what reference-static stiffnesses are multiplied by to become
  /// reference-dynamic ones; NaN without such a pair.
  double stiffness_ratio() const;
};

/// Of every direction that has frames, over rows from..to-1. Segments with missing samples are left
/// out. theta: reference parameters in table order, SI; empty: none. Empty when the stretch is
/// shorter than 8 s.
std::vector<TransferFunction> transfer_functions(const estimator::Structure& structure,
                                                 const SessionMotion& motion, Eigen::Index from,
                                                 Eigen::Index to, const Eigen::VectorXd& theta);

}  // namespace framewatch::daemon
