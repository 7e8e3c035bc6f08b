#pragma once

#include <Eigen/Core>

#include "estimator/refine/spectrum.h"

namespace framewatch::estimator {

/// How much later one reading of a motion is than another.
struct Delay {
  double seconds = 0;
  double likeness = 0;   ///< magnitude of the correlation then, 0..1
  double undelayed = 0;  ///< the same without a delay
};

/// Of `second` behind `first`, at most half of their length, in a band where they differ by a
/// factor. Likeness is 0 where fewer than eight frequencies lie in the band. Source: the
/// cross-correlation's largest magnitude; Bendat and Piersol, Random Data, 2010, ch. 5.
Delay delay_between(const Eigen::VectorXd& first, const Eigen::VectorXd& second, double rate_hz,
                    const Band& band);

}  // namespace framewatch::estimator
