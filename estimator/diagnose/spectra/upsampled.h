#pragma once

#include <Eigen/Core>

namespace framewatch::estimator {

/// The signal at ratio times its rate, delayed by `shift` samples, interpolated by a windowed sinc.
Eigen::VectorXd upsampled(const Eigen::VectorXd& signal, int ratio, double shift = 0);

}  // namespace framewatch::estimator
