#include "estimator/gap/gap_meter.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace framewatch::estimator {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

GapMeter::GapMeter(const std::vector<char>& compared, double rate_hz, int window_s)
    : compared_(compared),
      per_second_(std::max(1, static_cast<int>(std::lround(rate_hz)))),
      window_s_(window_s),
      seconds_(static_cast<std::size_t>(window_s) * compared.size()) {
  gap_.axis_nrmse.assign(compared.size(), kUnknown);
  gap_.axis_floor = gap_.axis_nrmse;
  restart();
}

void GapMeter::restart() {
  std::fill(seconds_.begin(), seconds_.end(), Sum{});
  newest_ = full_ = instants_ = 0;
}

void GapMeter::add(std::size_t axis, double measured, double simulated) {
  Sum& sum = of(newest_, axis);
  const double difference = measured - simulated;
  sum.difference += difference * difference;
  sum.measured += measured * measured;
  ++sum.count;
}

bool GapMeter::close(Time time, const std::vector<double>& noise_variance) {
  if (!ends_second()) {
    ++instants_;
    return false;
  }
  instants_ = 0;
  full_ = std::min(full_ + 1, window_s_);
  const bool whole = full_ == window_s_;
  if (whole) {
    gap_.end = time;
    gap_.start = time - std::chrono::seconds(window_s_);
    compare(noise_variance);
  }
  newest_ = (newest_ + 1) % window_s_;
  for (std::size_t a = 0; a < compared_.size(); ++a) of(newest_, a) = {};
  return whole;
}

void GapMeter::compare(const std::vector<double>& noise_variance) {
  double difference = 0, measured = 0, noise = 0;
  for (std::size_t a = 0; a < compared_.size(); ++a) {
    gap_.axis_nrmse[a] = gap_.axis_floor[a] = kUnknown;
    if (!compared_[a]) continue;
    Sum sum;
    for (int s = 0; s < window_s_; ++s) {
      sum.difference += of(s, a).difference;
      sum.measured += of(s, a).measured;
      sum.count += of(s, a).count;
    }
    if (sum.count == 0 || !(sum.measured > 0)) continue;
    const double expected = static_cast<double>(sum.count) * noise_variance[a];
    gap_.axis_nrmse[a] = std::sqrt(sum.difference / sum.measured);
    gap_.axis_floor[a] = std::sqrt(expected / sum.measured);
    difference += sum.difference;
    measured += sum.measured;
    noise += expected;
  }
  gap_.nrmse = std::sqrt(difference / measured);
  gap_.floor = std::sqrt(noise / measured);
}

}  // namespace framewatch::estimator
