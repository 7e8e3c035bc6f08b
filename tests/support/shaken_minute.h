// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "estimator/pipeline/pipeline.h"

namespace framewatch::test {

/// Table 1's building under a minute of strong shaking with 5 % noise on every accelerometer, and
/// the output of a pipeline with a wrong design.
class ShakenMinute {
 public:
  static constexpr double kDuration_s = 60, kNoise = 0.05;
  /// The loss of a frame of the first story, and its time.
  static constexpr double kDamage = 0.05, kDamage_s = 30;

  ShakenMinute();
  int frame() const { return frame_; }
  const estimator::ParameterTable& table() const { return table_; }
  /// By WindowEstimate::window.
  std::vector<double> windows_s() const;
  /// Returns every window of one motion.
  void run(std::uint64_t seed, bool damaged,
           const std::function<void(const estimator::WindowEstimate&)>& take) const;

 private:
  Eigen::MatrixXd motion(std::uint64_t seed, bool damaged) const;

  estimator::Structure structure_;
  estimator::ParameterTable table_;
  int frame_;
};

}  // namespace framewatch::test
