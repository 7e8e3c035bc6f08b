// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "estimator/refine/spectrum.h"

namespace framewatch::estimator {

/// Returns the spectrum of a real signal at bins 0..size/2, as a sum over samples. Fast if the size
/// has no prime factor above 5.
Eigen::VectorXcd forward_fourier(const Eigen::VectorXd& signal);

/// Returns the real signal of `size` samples whose bins 0..size/2 are `half`; missing bins are
/// zero. The inverse of forward_fourier().
Eigen::VectorXd inverse_fourier(const Eigen::VectorXcd& half, Eigen::Index size);

/// Returns the largest number <= `size` without a prime factor above 5; 0 for 0.
Eigen::Index smooth_size(Eigen::Index size);

/// Returns the signal at `ratio` times its rate, delayed by `shift` samples, interpolated with a
/// windowed sinc.
Eigen::VectorXd upsampled(const Eigen::VectorXd& signal, int ratio, double shift = 0);

/// Delay between two readings of the same motion.
struct Delay {
  double seconds = 0;
  double likeness = 0;   ///< magnitude of the correlation at this delay, 0..1
  double undelayed = 0;  ///< magnitude of the correlation without a delay, 0..1
};

/// Returns the delay of `second` behind `first` by the largest magnitude of their
/// cross-correlation. The delay is at most half of their length. band: where the readings differ
/// only by a factor. Likeness is 0 if fewer than eight frequencies lie in the band. Source: Bendat
/// and Piersol, Random Data, 2010, ch. 5.
Delay delay_between(const Eigen::VectorXd& first, const Eigen::VectorXd& second, double rate_hz,
                    const Band& band);

}  // namespace framewatch::estimator
