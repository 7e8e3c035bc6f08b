// SPDX-License-Identifier: MIT
#include "tests/support/noisy_stretch.h"

#include <cmath>

namespace framewatch::test {
namespace {

constexpr double kWhole_s = 15;

}  // namespace

ExactRecord exact_stretch(const estimator::Structure& structure, const Eigen::VectorXd& truth,
                          const estimator::PlanMotion& motion, double noise_ratio, double from_s,
                          double to_s) {
  ExactRecord out = daemon::exact_record(structure, truth, motion, noise_ratio, kWhole_s);
  const auto first = std::llround(from_s * daemon::kTrialRate_hz);
  const auto last = std::llround(to_s * daemon::kTrialRate_hz);
  out.accel_abs = out.accel_abs.middleRows(first, last - first + 1).eval();
  return out;
}

}  // namespace framewatch::test
