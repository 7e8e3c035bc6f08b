#pragma once

#include <Eigen/Core>

namespace framewatch::estimator {

/// Returns the spectrum of a real signal at bins 0..size/2, as a sum over samples. Fast if the size
/// has no prime factor above 5.
Eigen::VectorXcd forward_fourier(const Eigen::VectorXd& signal);

/// Returns the real signal of `size` samples whose bins 0..size/2 are `half`; missing bins are
/// zero. The inverse of forward_fourier().
Eigen::VectorXd inverse_fourier(const Eigen::VectorXcd& half, Eigen::Index size);

/// Returns the largest number <= `size` without a prime factor above 5; 0 for 0.
Eigen::Index smooth_size(Eigen::Index size);

}  // namespace framewatch::estimator
