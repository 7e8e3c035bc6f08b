// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Highest frequency of measured modes over the sampling rate: sensors' filters leave it unharmed.
inline constexpr double kMeasuredBand = 0.4;

/// A recorded motion in the form that measured_modes() needs. Samples are evenly spaced and finite.
struct RecordedMotion {
  double rate_hz = 0;
  Eigen::MatrixXd outputs;  ///< instants x compared_axes(), relative to the base, m/s^2
  Eigen::MatrixXd inputs;   ///< instants x axes of the base and forces; no columns: unknown
  Eigen::VectorXd delay_s;  ///< of the outputs
};

/// Returns the motion of the rows from..to-1. accel: instants x axes, m/s^2, absolute; without NaN
/// in these rows.
RecordedMotion recorded_motion(const Structure& structure, const std::vector<SensorAxis>& axes,
                               double rate_hz, const Eigen::MatrixXd& accel, Eigen::Index from,
                               Eigen::Index to);

/// A mode found in a record, without a model of the building.
struct MeasuredMode {
  double frequency_hz = 0, damping_ratio = 0;
  /// Half the range of the middle half of the values over the orders of the fitted system. It is
  /// not a standard error.
  double frequency_spread_hz = 0, damping_spread = 0;
  Eigen::VectorXcd shape;  ///< by output; the largest entry is 1
  int orders = 0;          ///< number of orders at which the mode is stable
};

/// Returns the modes that fitted systems of rising order agree on, by ascending frequency, up to
/// kMeasuredBand of the sampling rate. docs/equations.md (67). Returns no modes of a record with
/// less than a few hundred samples.
///
/// Method: subspace identification with inputs (PO-MOESP: Verhaegen, Automatica 30 (1994), 61) in
/// bands of halved and halved sampling rate, with a diagram of stabilisation in each.
std::vector<MeasuredMode> measured_modes(const RecordedMotion& motion);

}  // namespace framewatch::estimator
