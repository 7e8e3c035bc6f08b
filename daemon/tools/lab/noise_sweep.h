#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/base/workers.h"
#include "estimator/simulate/ground_motion.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {

/// The paper's examples with noise (Figures 6 and 7): Table 2(c), first 10 s of a motion at 45
/// degrees, identified over given, mean over noise seeds, by noise level.
struct NoiseSweep {
  estimator::ParameterTable table;
  std::vector<double> noise_ratio;
  std::vector<Eigen::VectorXd> paper;     ///< independent noise on a, v and d
  std::vector<Eigen::VectorXd> denoised;  ///< the same behind the removal of noise
  std::vector<Eigen::VectorXd> matched;   ///< ours: noise on accelerations, last 5 of the 10 s
};

NoiseSweep sweep_noise(const estimator::GroundMotion& motion, int seeds, const Workers& workers);

}  // namespace framewatch::daemon
