// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/motion/acquisition.h"
#include "estimator/pipeline/pipeline.h"

namespace framewatch::daemon {

/// Collects one segment of calibrated instants, in the form that the pipeline gets.
class SegmentCollector {
 public:
  /// `from_s` and `to_s` count from the first sample.
  SegmentCollector(const estimator::PipelineConfig& config, double from_s, double to_s);

  void push(const estimator::AccelSample& sample);
  /// Ends the input: keeps the instants that are still open.
  void finish();

  /// Returns the segment: instants x axes, m/s^2; NaN for missing samples.
  Eigen::MatrixXd accel() const;
  /// Returns the axes with the rest of their delay, which is less than a sample.
  const std::vector<estimator::SensorAxis>& axes() const { return acquisition_.axes(); }
  bool started() const { return started_; }
  std::int64_t first_us() const { return first_us_; }

 private:
  void keep(const estimator::SampleSet& set);

  double from_us_, to_us_;
  estimator::Acquisition acquisition_;
  bool started_ = false;
  std::int64_t first_us_ = 0, next_index_ = -1;
  std::vector<double> kept_;
};

}  // namespace framewatch::daemon
