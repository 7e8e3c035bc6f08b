// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/tools/report/session_motion.h"

namespace framewatch::daemon {

/// Mean acceleration of a direction's frames at the top floor over the acceleration of the base
/// along the same direction: cross spectrum over the base's spectrum (H1), from Hann segments that
/// overlap by half. `model` is the same quotient for the model driven by the same base motion.
struct TransferFunction {
  estimator::Direction direction;
  int segments = 0;
  std::vector<double> frequency_hz;
  std::vector<double> measured;   ///< absolute value, 1
  std::vector<double> coherence;  ///< 0..1
  std::vector<double> model;      ///< empty without reference values, or over 100 unknowns
  /// The lowest peak of the model's motion along the direction, and the measured peak at 0.6 to 1.6
  /// times its frequency whose shape is most like it (MAC); NaN: no peak is alike.
  double measured_mode_hz = 0, model_mode_hz = 0;
  double mac = 0;            ///< of the two shapes, weighted by mass: 1 is the same; NaN: no pair
  std::string no_pair = {};  ///< why no modes were paired; empty: a pair was found

  /// Returns (measured over model)^2, the factor from reference-static to reference-dynamic
  /// stiffnesses; NaN without a pair of modes.
  double stiffness_ratio() const;
};

/// Computes the transfer function of every direction that has frames, over rows from..to-1.
/// Segments with missing samples are skipped. theta: reference parameters in table order, SI; may
/// be empty. Returns an empty vector when the stretch is shorter than 8 s.
std::vector<TransferFunction> transfer_functions(const estimator::Structure& structure,
                                                 const SessionMotion& motion, Eigen::Index from,
                                                 Eigen::Index to, const Eigen::VectorXd& theta);

}  // namespace framewatch::daemon
