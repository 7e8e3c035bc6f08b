#pragma once

#include <Eigen/Core>

namespace framewatch::estimator {

/// Spectrum of a real signal at bins 0..size/2, sum of samples. Fast when the size has no prime
/// factor above 5.
Eigen::VectorXcd forward_fourier(const Eigen::VectorXd& signal);

/// The real signal of `size` samples whose bins 0..size/2 are `half` (shorter: zero above), such
/// that it undoes forward_fourier.
Eigen::VectorXd inverse_fourier(const Eigen::VectorXcd& half, Eigen::Index size);

/// The largest number <= `size` without a prime factor above 5; 0 for 0.
Eigen::Index smooth_size(Eigen::Index size);

}  // namespace framewatch::estimator
