// SPDX-License-Identifier: MIT
#include "estimator/gap/gap.h"

#include <algorithm>
#include <cmath>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

constexpr double kOver = 0.5;  ///< of raise_ratio: below it a gap is over

double excess(double nrmse, double floor) {
  return std::sqrt(std::max(0.0, nrmse * nrmse - floor * floor));
}

int worst_axis(const GapWindow& w) {
  int worst = -1;
  double most = 0;
  for (std::size_t a = 0; a < w.axis_nrmse.size(); ++a) {
    const double e = excess(w.axis_nrmse[a], w.axis_floor[a]);
    if (!(e > most)) continue;
    most = e;
    worst = static_cast<int>(a);
  }
  return worst;
}

}  // namespace

GapMeter::GapMeter(const std::vector<char>& compared, double rate_hz, int window_s)
    : compared_(compared),
      per_second_(std::max(1, static_cast<int>(std::lround(rate_hz)))),
      window_s_(window_s),
      seconds_(static_cast<std::size_t>(window_s) * compared.size()) {
  gap_.axis_nrmse.assign(compared.size(), kNaN);
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
    gap_.axis_nrmse[a] = gap_.axis_floor[a] = kNaN;
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

std::optional<Time> GapAlarm::showing() const {
  return !raised_ && seconds_ > 0 ? std::optional(shown_) : std::nullopt;
}

const GapNews* GapAlarm::push(const GapWindow& w) {
  if (!(w.floor < options_.raise_ratio)) return nullptr;
  const double now = excess(w.nrmse, w.floor);
  const bool otherwise = raised_ ? now < kOver * options_.raise_ratio : now > options_.raise_ratio;
  if (!otherwise) {
    seconds_ = 0;
    return nullptr;
  }
  if (seconds_++ == 0) since_ = w.start, shown_ = w.end;
  if (seconds_ < options_.lasting_s) return nullptr;
  seconds_ = 0;
  news_.found = w.end;
  news_.excess = now;
  if (raised_) {
    raised_ = false;
    news_.state = AlarmState::cleared;
    return &news_;
  }
  raised_ = true;
  news_.state = AlarmState::raised;
  news_.id = to_microseconds(w.end);
  news_.since = since_;
  news_.worst_axis = worst_axis(w);
  return &news_;
}

}  // namespace framewatch::estimator
