// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/numeric/nan.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// How well the other floors' channels alone predict the motion of a measured floor, as a test of
/// floors without sensors. Errors are rms of the error over rms of the motion, for the mean of the
/// floor's channels along the direction; NaN: samples are missing, or nothing moves.
struct LeftOutFloor {
  int floor = 0;
  Direction direction = Direction::x;
  double error = kNaN;       ///< above the high-pass
  double low_error = kNaN;   ///< the part below kLeftOutLow_hz
  double spline = kNaN;      ///< error of a natural cubic spline in height
  double low_spline = kNaN;  ///< the part below kLeftOutLow_hz
};

inline constexpr double kLeftOutLow_hz = 5;

/// Leaves out every measured floor below the highest one in turn and returns the errors, from the
/// lowest floor up, x before y. config: grouped parameters. theta: identified, config.parameters(),
/// SI. accel: instants x axes, m/s^2, absolute. Rows first to end - 1 are judged; the others settle
/// the filters, which are fourth-order Butterworth filters forth and back at options.high_pass_hz
/// and kLeftOutLow_hz.
std::vector<LeftOutFloor> leave_floors_out(const PipelineConfig& config,
                                           const Eigen::VectorXd& theta,
                                           const Eigen::MatrixXd& accel, Eigen::Index first,
                                           Eigen::Index end);

/// Returns the weights of the values at ascending places in the natural cubic spline's value `at`
/// another place.
Eigen::VectorXd spline_weights(const std::vector<double>& places, double at);

}  // namespace framewatch::estimator
