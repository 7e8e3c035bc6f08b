#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/refine/spectrum.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// bad_input: wrong sizes, or a rate or parameter that is not > 0; bad_samples: not finite.
enum class SegmentStatus { good, bad_input, missing_sensors, bad_samples, too_short };

/// Cramer-Rao bound: the least standard deviation of any unbiased estimator.
struct CramerRaoBound {
  SegmentStatus status = SegmentStatus::bad_input;
  Eigen::VectorXd std_error;  ///< theta order, SI; infinite where the motion has no information
  Band band;
  int bins = 0;
};

/// Bound of all parameters together from one segment. Every axis is measured with its own white
/// noise (SensorAxis::noise_density); the input and the states at both ends are unknown. theta: the
/// true parameters, > 0; accel_abs: instants x axes, exact, m/s^2.
CramerRaoBound cramer_rao_bound(const Structure& structure, const std::vector<SensorAxis>& axes,
                                const Eigen::VectorXd& theta, double rate_hz,
                                const Eigen::MatrixXd& accel_abs);

/// Whether theta can be estimated from such a segment.
SegmentStatus check_segment(const Structure& structure, const std::vector<SensorAxis>& axes,
                            const Eigen::VectorXd& theta, double rate_hz,
                            const Eigen::MatrixXd& accel_abs);

/// Square roots of the diagonal of the inverse of an information matrix; infinite for parameters
/// with a share in a direction without information.
Eigen::VectorXd bound_of(const Eigen::MatrixXd& information);

}  // namespace framewatch::estimator
