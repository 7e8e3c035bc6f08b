#pragma once

#include <Eigen/Core>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {

/// Band-limited white noise of rms 1: `rows` samples, every harmonic of their length between low_hz
/// and high_hz with an amplitude and phase of its own. Precondition: a harmonic lies in the band.
Eigen::VectorXd band_noise(Eigen::Index rows, double rate_hz, double low_hz, double high_hz,
                           Random& random);

}  // namespace framewatch::estimator
