#pragma once

#include <cstdint>

#include "estimator/identify/solve/batch_least_squares.h"

namespace framewatch::daemon {

/// Noise as in the paper's examples: every acceleration, velocity and displacement has white noise
/// of its own between 0.075 and 150 rad/s, noise_ratio times its rms.
estimator::MotionHistory with_paper_noise(const estimator::MotionHistory& exact, double rate_hz,
                                          double noise_ratio, std::uint64_t seed);

/// Every channel with the paper's removal of noise (p = 200, q = 5, s(r) >= 0.98).
estimator::MotionHistory denoised(const estimator::MotionHistory& noisy);

}  // namespace framewatch::daemon
