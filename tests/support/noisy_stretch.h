#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/simulate/ground_motion.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::test {

/// Exact motion of a building at 100 Hz and the axes that measure it.
struct ExactStretch {
  std::vector<SensorAxis> axes;  ///< noise densities set
  Eigen::MatrixXd accel_abs;     ///< instants x axes, m/s^2
};

/// The stretch from_s..to_s of the response to a motion that starts at rest at 0; noise of every
/// axis noise_ratio times the rms of its motion from 0 to 15 s.
ExactStretch exact_stretch(const Structure& structure, const Eigen::VectorXd& truth,
                           const PlanMotion& motion, double noise_ratio, double from_s = 5,
                           double to_s = 10);

/// The stretch with the axes' white noise on it.
Eigen::MatrixXd with_noise(const ExactStretch& stretch, std::uint64_t seed);

/// An artificial motion of 15 s at 45 degrees.
PlanMotion oblique_motion(std::uint64_t seed);

}  // namespace framewatch::test
