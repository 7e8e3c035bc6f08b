#pragma once

#include <Eigen/Core>

#include "estimator/refine/spectrum.h"

namespace framewatch::estimator {

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
