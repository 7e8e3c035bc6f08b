// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "daemon/tools/lab/accuracy_trial.h"

namespace framewatch::test {

using daemon::ExactRecord;
using daemon::oblique_motion;
using daemon::with_noise;

/// The segment from_s..to_s of the response to a motion that starts at rest at 0; noise of every
/// axis noise_ratio times the rms of its motion from 0 to 15 s.
ExactRecord exact_stretch(const estimator::Structure& structure, const Eigen::VectorXd& truth,
                          const estimator::PlanMotion& motion, double noise_ratio,
                          double from_s = 5, double to_s = 10);

}  // namespace framewatch::test
