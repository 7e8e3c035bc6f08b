// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimation/segment_collector.h"

#include <limits>

namespace framewatch::daemon {

SegmentCollector::SegmentCollector(const estimator::PipelineConfig& config, double from_s,
                                   double to_s)
    : from_us_(from_s * 1e6), to_us_(to_s * 1e6), acquisition_(config.axes, config.options) {}

void SegmentCollector::push(const estimator::AccelSample& sample) {
  if (!started_) first_us_ = to_microseconds(sample.time);
  started_ = true;
  for (const estimator::SampleSet& set : acquisition_.push(sample)) keep(set);
}

void SegmentCollector::finish() {
  for (const estimator::SampleSet& set : acquisition_.finish()) keep(set);
}

void SegmentCollector::keep(const estimator::SampleSet& set) {
  constexpr double kRounding_us = 1;  // stamps are whole microseconds
  const auto at_us = static_cast<double>(to_microseconds(set.time) - first_us_);
  if (at_us < from_us_ - kRounding_us || at_us > to_us_ + kRounding_us) return;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  if (next_index_ >= 0 && set.index != next_index_) kept_.insert(kept_.end(), axes().size(), kNan);
  kept_.insert(kept_.end(), set.accel.begin(), set.accel.end());
  next_index_ = set.index + 1;
}

Eigen::MatrixXd SegmentCollector::accel() const {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto count = static_cast<Eigen::Index>(axes().size());
  return Eigen::Map<const RowMajor>(kept_.data(), static_cast<Eigen::Index>(kept_.size()) / count,
                                    count);
}

}  // namespace framewatch::daemon
