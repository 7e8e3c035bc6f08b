#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/refine/spectrum.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch {

/// bad_input: sizes, a rate or parameters that are not > 0; bad_samples: not finite.
enum class StretchStatus { good, bad_input, missing_sensors, bad_samples, too_short };

/// The least standard deviation any unbiased estimator can have.
struct CramerRaoBound {
  StretchStatus status = StretchStatus::bad_input;
  Eigen::VectorXd std_error;  ///< theta order, SI; infinite where the motion shows nothing
  Band band;
  int bins = 0;
};

/// Of all parameters together from one stretch in which every axis is measured with its own white
/// noise (SensorAxis::noise_density), the input and the state at either end unknown.
/// theta: the true parameters, > 0; accel_abs: instants x axes, exact, m/s^2.
CramerRaoBound cramer_rao_bound(const Structure& structure, const std::vector<SensorAxis>& axes,
                                const Eigen::VectorXd& theta, double rate_hz,
                                const Eigen::MatrixXd& accel_abs);

/// Whether theta can be estimated from such a stretch at all.
StretchStatus check_stretch(const Structure& structure, const std::vector<SensorAxis>& axes,
                            const Eigen::VectorXd& theta, double rate_hz,
                            const Eigen::MatrixXd& accel_abs);

/// Square roots of the diagonal of the inverse; infinite in directions without information.
Eigen::VectorXd bound_of(const Eigen::MatrixXd& information);

}  // namespace framewatch
