#include "daemon/stretch_collector.h"

#include <cmath>
#include <limits>

namespace framewatch::daemon {

StretchCollector::StretchCollector(const PipelineConfig& config, double from_s, double to_s)
    : axes_(config.axes),
      from_us_(from_s * 1e6),
      to_us_(to_s * 1e6),
      merger_(static_cast<int>(axes_.size()), config.options.rate_hz, config.options.lateness_s),
      filler_(static_cast<int>(axes_.size()), config.options.fill_single_losses) {
  const double rate_hz = config.options.rate_hz;
  for (SensorAxis& axis : axes_) {
    const double whole_s = std::round(axis.delay * rate_hz) / rate_hz;
    whole_delay_us_.push_back(std::llround(whole_s * 1e6));
    axis.delay -= whole_s;
  }
}

void StretchCollector::push(const AccelSample& raw) {
  const auto a = static_cast<std::size_t>(raw.axis);
  const SensorAxis& axis = axes_[a];
  AccelSample sample = raw;
  sample.accel = axis.polarity * (axis.scale * raw.accel - axis.offset);
  sample.time -= SensorClock::duration(whole_delay_us_[a]);
  if (!started_) first_us_ = to_microseconds(raw.time);
  started_ = true;
  const bool taken = merger_.push(sample);
  drain();
  if (taken) return;
  (void)merger_.push(sample);
  drain();
}

void StretchCollector::finish() {
  merger_.finish();
  drain();
  while (const SampleSet* set = filler_.drain()) keep(*set);
}

void StretchCollector::drain() {
  while (const SampleSet* set = merger_.next())
    if (const SampleSet* repaired = filler_.push(*set)) keep(*repaired);
}

void StretchCollector::keep(const SampleSet& set) {
  constexpr double kRounding_us = 1;  // stamps are whole microseconds
  const auto at_us = static_cast<double>(to_microseconds(set.time) - first_us_);
  if (at_us < from_us_ - kRounding_us || at_us > to_us_ + kRounding_us) return;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  if (next_index_ >= 0 && set.index != next_index_) kept_.insert(kept_.end(), axes_.size(), kNan);
  kept_.insert(kept_.end(), set.accel.begin(), set.accel.end());
  next_index_ = set.index + 1;
}

Eigen::MatrixXd StretchCollector::accel() const {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto axes = static_cast<Eigen::Index>(axes_.size());
  return Eigen::Map<const RowMajor>(kept_.data(), static_cast<Eigen::Index>(kept_.size()) / axes,
                                    axes);
}

}  // namespace framewatch::daemon
