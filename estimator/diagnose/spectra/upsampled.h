#pragma once

#include <Eigen/Core>

namespace framewatch::estimator {

/// Returns the signal at `ratio` times its rate, delayed by `shift` samples, interpolated with a
/// windowed sinc.
Eigen::VectorXd upsampled(const Eigen::VectorXd& signal, int ratio, double shift = 0);

}  // namespace framewatch::estimator
