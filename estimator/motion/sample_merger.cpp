// SPDX-License-Identifier: MIT
#include "estimator/motion/sample_merger.h"

#include <algorithm>
#include <cmath>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

constexpr double kOffGrid = 0.3;     // steps from an instant beyond which a sample is rejected
constexpr double kPhaseGain = 0.02;  // rate at which the grid follows the stamps
constexpr std::int64_t kBeyondLateness = 8;  // further instants that may be open
constexpr double kSurelyRounded = 1e9;  // steps below which two ways to round agree within kNear
constexpr double kNear = 0.49;  // steps from an instant: half a step, less what rounding may err

}  // namespace

SampleMerger::SampleMerger(int axes, double rate_hz, double lateness_s)
    : step_us_(1e6 / rate_hz),
      steps_per_us_(1 / step_us_),
      lateness_(std::max<std::int64_t>(1, std::llround(lateness_s * rate_hz))),
      stray_limit_(2 * axes + 4) {
  const auto count = static_cast<std::size_t>(axes);
  open_.resize(static_cast<std::size_t>(lateness_ + kBeyondLateness));
  for (Instant& i : open_) {
    i.accel.resize(count);
    i.has.resize(count);
    clear(i);
  }
  silent_.assign(count, 0);
  counters_.assign(count, {});
  set_.accel.resize(count);
}

void SampleMerger::clear(Instant& instant) {
  std::fill(instant.accel.begin(), instant.accel.end(), kNaN);
  std::fill(instant.has.begin(), instant.has.end(), std::uint8_t{0});
  instant.delivered = 0;
}

std::int64_t SampleMerger::index_of(double time_us) const {
  // Most samples lie near an instant, and a product finds it sooner than a quotient that is
  // rounded.
  const double about = (time_us - phase_us_) * steps_per_us_;
  if (std::abs(about) < kSurelyRounded) {
    const auto near = static_cast<std::int64_t>(about + (about < 0 ? -0.5 : 0.5));
    if (std::abs(about - static_cast<double>(near)) < kNear) return origin_ + near;
  }
  const double steps = std::clamp((time_us - phase_us_) / step_us_, -9e15, 9e15);
  return origin_ + std::llround(steps);
}

void SampleMerger::anchor(double time_us) {
  for (Instant& i : open_) clear(i);
  phase_us_ = time_us;
  // A new anchor makes the index jump, so readers of the sets see the interruption.
  origin_ = anchored_ ? std::max(newest_, first_open_) + 2 : 0;
  first_open_ = origin_;
  newest_ = origin_ - 1;
  strays_ = 0;
  anchored_ = true;
}

void SampleMerger::stray(const AccelSample& sample) {
  const double time_us = static_cast<double>(to_microseconds(sample.time));
  const bool together = strays_ > 0 && std::abs(time_us - stray_time_us_) < 1e6;
  strays_ = together ? strays_ + 1 : 1;
  stray_time_us_ = time_us;
  if (strays_ > stray_limit_) anchor(time_us);
}

bool SampleMerger::push(const AccelSample& sample) {
  const auto axis = static_cast<std::size_t>(sample.axis);
  AxisCounters& counter = counters_[axis];
  const double time_us = static_cast<double>(to_microseconds(sample.time));
  if (!anchored_) anchor(time_us);
  std::int64_t index = index_of(time_us);
  if (index < first_open_ - lateness_ ||
      index >= first_open_ + static_cast<std::int64_t>(open_.size()) + lateness_) {
    stray(sample);
    index = index_of(time_us);
    if (strays_ > 0) {
      ++counter.received;
      ++counter.rejected;
      return true;
    }
  }
  strays_ = 0;
  const double off = time_us - (phase_us_ + step_us_ * static_cast<double>(index - origin_));
  const bool off_grid = std::abs(off) > kOffGrid * step_us_;
  if (index >= first_open_ + static_cast<std::int64_t>(open_.size()) && !off_grid) {
    newest_ = index;
    return false;
  }
  ++counter.received;
  if (index < first_open_) {
    ++counter.late;
    set_silent(axis, false);
    return true;
  }
  Instant& slot = instant(index);
  if (off_grid || std::isfinite(slot.accel[axis])) {
    ++counter.rejected;
    return true;
  }
  newest_ = std::max(newest_, index);
  // A NaN still counts as delivered, so the instant does not wait for the axis.
  if (std::isfinite(sample.accel))
    slot.accel[axis] = sample.accel;
  else
    ++counter.rejected;
  if (slot.has[axis] == 0) ++slot.delivered;
  slot.has[axis] = 1;
  set_silent(axis, false);
  phase_us_ += kPhaseGain * off / static_cast<double>(silent_.size());
  return true;
}

void SampleMerger::set_silent(std::size_t axis, bool silent) {
  if ((silent_[axis] != 0) == silent) return;
  silent_[axis] = silent ? 1 : 0;
  silent ? ++silent_count_ : --silent_count_;
}

bool SampleMerger::complete(const Instant& instant) const {
  // Called for every sample; the count alone usually decides.
  if (static_cast<std::size_t>(instant.delivered) + silent_count_ < silent_.size()) return false;
  for (std::size_t a = 0; a < silent_.size(); ++a)
    if (instant.has[a] == 0 && silent_[a] == 0) return false;
  return instant.delivered > 0;
}

const SampleSet* SampleMerger::next() {
  if (!anchored_ || first_open_ > newest_) return nullptr;
  Instant& oldest = instant(first_open_);
  const bool overdue = newest_ - first_open_ > lateness_;
  if (!complete(oldest) && !overdue && !finishing_) return nullptr;
  for (std::size_t a = 0; a < silent_.size(); ++a) {
    if (oldest.has[a] != 0) continue;
    ++counters_[a].missing;
    if (overdue) set_silent(a, true);
  }
  set_.index = first_open_;
  set_.time = from_microseconds(
      std::llround(phase_us_ + step_us_ * static_cast<double>(first_open_ - origin_)));
  std::copy(oldest.accel.begin(), oldest.accel.end(), set_.accel.begin());
  clear(oldest);
  ++first_open_;
  if (first_open_ - origin_ >= 4096) {
    phase_us_ += step_us_ * static_cast<double>(first_open_ - origin_);
    origin_ = first_open_;
  }
  return &set_;
}

}  // namespace framewatch::estimator
