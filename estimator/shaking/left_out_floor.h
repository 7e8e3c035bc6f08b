#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/numeric/nan.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// How well the motion of a measured floor is known from the other floors' channels alone: what to
/// expect where there is none. Rms of the error over rms of the motion, of the mean of the floor's
/// channels along the direction; NaN: samples are missing, or nothing moves.
struct LeftOutFloor {
  int floor = 0;
  Direction direction = Direction::x;
  double error = kNaN;       ///< above the high-pass
  double low_error = kNaN;   ///< of that, below kLeftOutLow_hz
  double spline = kNaN;      ///< the same of a natural cubic spline through the other floors
  double low_spline = kNaN;  ///< in height
};

inline constexpr double kLeftOutLow_hz = 5;

/// Every measured floor below the highest one left out in turn, upward, of one floor x first.
/// config: of groups; theta: identified, config.parameters(), SI. accel: instants x axes, m/s^2,
/// absolute, of which rows first to end - 1 are judged; the rest is for the filters, which are
/// fourth-order Butterworth filters forth and back at options.high_pass_hz and kLeftOutLow_hz.
std::vector<LeftOutFloor> leave_floors_out(const PipelineConfig& config,
                                           const Eigen::VectorXd& theta,
                                           const Eigen::MatrixXd& accel, Eigen::Index first,
                                           Eigen::Index end);

/// Weights of the values at ascending places in the natural cubic spline's value at another one.
Eigen::VectorXd spline_weights(const std::vector<double>& places, double at);

}  // namespace framewatch::estimator
