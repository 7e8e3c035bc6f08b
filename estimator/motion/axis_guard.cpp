// SPDX-License-Identifier: MIT
#include "estimator/motion/axis_guard.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "estimator/numeric/nan.h"
#include "estimator/numeric/quantile.h"

namespace framewatch::estimator {
namespace {

constexpr unsigned kNewest = 1, kOldest = 1u << SpikeGuard::kLookAhead;
constexpr int kNeverStirred = 1000000;
constexpr double kRises = 1.3;  // ratio to the first doubtful sample
constexpr double kNeverChanged = std::numeric_limits<double>::infinity();

}  // namespace

SpikeGuard::SpikeGuard(const std::vector<int>& groups, double rate_hz)
    : second_(std::max(2, static_cast<int>(std::lround(rate_hz)))),
      period_(std::max(2, static_cast<int>(std::lround(kPeriod_s * rate_hz)))),
      longest_(static_cast<int>(std::lround(kLongest_s * rate_hz))),
      axis_(groups.size()) {
  const bool one = std::adjacent_find(groups.begin(), groups.end(),
                                      [](int a, int b) { return a != b; }) == groups.end();
  for (std::size_t a = 0; a < axis_.size(); ++a) {
    axis_[a].group = one ? static_cast<int>(a) : groups[a];
    axis_[a].still = kNeverStirred;
  }
}

bool SpikeGuard::beyond(const Axis& a, double value, double steps) const {
  const double reach = steps * std::max({a.step, a.step_before, a.least_step});
  return value > std::max(a.high, a.high_before) + reach ||
         value < std::min(a.low, a.low_before) - reach;
}

/// Takes a sound value into the statistics of its axis. Repeated values are left out: they come
/// from quiet and from stuck sensors alike.
void SpikeGuard::take(Axis& a, double value) const {
  if (a.seen > 0 && value == a.last) return;
  if (a.seen == 0) {
    a.change = a.step = a.step_before = 0;
    a.low = a.high = a.low_before = a.high_before = value;
    a.in_period = 0;
  } else {
    a.change = std::abs(value - a.last);
    a.step += (a.change - a.step) / a.seen;
  }
  a.seen = std::min(a.seen + 1, second_);
  a.last = value;
  if (a.in_period == period_) {
    a.low_before = a.low;
    a.high_before = a.high;
    a.step_before = a.step;
    a.low = a.high = value;
    a.in_period = 0;
  }
  a.low = std::min(a.low, value);
  a.high = std::max(a.high, value);
  ++a.in_period;
}

void SpikeGuard::push(int axis, double value, double finest) {
  Axis& a = of(axis);
  std::copy_backward(a.held.begin(), a.held.end() - 1, a.held.end());
  a.held[0] = value;
  a.doubtful <<= 1;
  a.back <<= 1;
  a.least_step = finest > 0 ? std::max(kMinStep, finest) : kNeverChanged;
  a.still = std::min(a.still + 1, kNeverStirred);
  if (a.seen == second_ && std::abs(value - a.last) > kStirred * std::max(a.step, a.least_step))
    a.still = 0;
}

bool SpikeGuard::others_stir(int axis) const {
  bool any = false;
  for (int b = 0; b < static_cast<int>(axis_.size()); ++b) {
    const Axis& other = axis_[static_cast<std::size_t>(b)];
    if (b == axis || std::isnan(other.held[0])) continue;
    if (other.still <= kStirring && other.group != of(axis).group) return true;
    any = true;
  }
  return !any;  // no other axis contradicts it
}

/// Takes the values of these ages, the oldest first. Returns the ages.
unsigned SpikeGuard::take_ages(Axis& a, unsigned ages) const {
  for (int age = kLookAhead; age >= 0; --age)
    if ((ages >> age & 1u) != 0) take(a, a.held[static_cast<std::size_t>(age)]);
  return ages;
}

/// Decides all waiting samples. `sound` decides the doubtful ones.
SpikeGuard::Decided SpikeGuard::decide_all(Axis& a, bool sound) {
  const Decided out{take_ages(a, sound ? a.doubtful | a.back : a.back), sound ? 0 : a.doubtful};
  a.doubtful = a.back = 0;
  a.out = 0;
  a.rejected = a.rings = a.violent = false;
  return out;
}

SpikeGuard::Decided SpikeGuard::decide(int axis) {
  Axis& a = of(axis);
  const double value = a.held[0];
  const bool is_value = !std::isnan(value);
  const bool far = is_value && beyond(a, value, kFar);
  if (a.out == 0) {
    if (!is_value) return {};
    if (a.seen < second_ || !far || std::abs(value - a.last) <= kAbrupt * a.change) {
      take(a, value);
      return {kNewest, 0};
    }
  }
  ++a.out;
  if (is_value && beyond(a, value, kBack)) {
    const bool rises = a.out == 2 && (value - a.last) / (a.held[1] - a.last) > kRises;
    a.rings = a.rings || a.back != 0 || !far || rises;
    a.violent = a.violent || std::abs(value - a.last) > kMaxAlone;
    a.doubtful |= kNewest;
  } else if (is_value) {
    a.back |= kNewest;
  }
  if (a.out > longest_) {
    a.seen = 0;
    return decide_all(a, true);
  }
  if (others_stir(axis) || (a.rings && !a.violent && !a.rejected)) return decide_all(a, true);
  Decided out{take_ages(a, a.back & kOldest), a.doubtful & kOldest};
  a.doubtful &= ~kOldest;
  a.back &= ~kOldest;
  a.rejected = a.rejected || out.absurd != 0;
  if (a.doubtful == 0) out.sound |= decide_all(a, true).sound;
  return out;
}

SpikeGuard::Decided SpikeGuard::finish(int axis) {
  Axis& a = of(axis);
  return a.doubtful == 0 ? Decided{} : decide_all(a, others_stir(axis));
}

namespace {

constexpr double kMemory_s = 1;        // of the mean step
constexpr double kRatioMemory_s = 10;  // of the ratio of an axis's motion to its neighbors'
constexpr double kStrongestMemory_s = 120;
// Share of the strongest motion, below which a recorder ends its record.
constexpr double kStrong = 1.0 / 3;
constexpr double kLongRun_s = 0.5;    // equal samples are stuck after this time if the others move
constexpr double kMovingFast = 50;    // resolutions per sample: equal samples are then no accident
constexpr double kOthersMove = 10;    // resolutions per sample that the others predict
constexpr double kFullScale = 0.999;  // share of the configured range
constexpr int kClippedRun = 3;    // equal samples at the largest value so far, which are clipped
constexpr double kFarFiner = 16;  // ratio of the smallest step to a far finer change
constexpr int kFinerRun = 300;    // number of such changes before they are accepted

std::vector<int> groups_of(const std::vector<AxisGuard::Axis>& axes) {
  std::vector<int> out;
  for (const AxisGuard::Axis& axis : axes) out.push_back(axis.group);
  return out;
}

}  // namespace

AxisGuard::AxisGuard(const std::vector<Axis>& axes, double rate_hz, bool lone_spikes)
    : forget_(std::min(1.0, 1 / (kMemory_s * rate_hz))),
      keep_strongest_(1 - std::min(1.0, 1 / (kStrongestMemory_s * rate_hz))),
      forget_ratio_(std::min(1.0, kSlots / (kRatioMemory_s * rate_hz))),
      long_run_(std::max(kLookAhead + 1, static_cast<int>(std::lround(kLongRun_s * rate_hz)))),
      lone_spikes_(lone_spikes),
      state_(axes.size()),
      spikes_(groups_of(axes), rate_hz),
      ring_(kSlots) {
  for (std::size_t a = 0; a < axes.size(); ++a) state_[a].axis = axes[a];
  for (std::size_t a = 0; a < axes.size(); ++a) {
    alone_.push_back(1);
    for (std::size_t b = 0; b < axes.size(); ++b)
      if (b != a && axes[b].judged && axes[b].direction == axes[a].direction) alone_[a] = 0;
  }
  for (SampleSet& set : ring_) set.accel.resize(axes.size());
  out_.accel.resize(axes.size());
  sorted_.reserve(axes.size());
  stuck_.assign(axes.size(), 0);
  clipped_.assign(axes.size(), 0);
  absurd_.assign(axes.size(), 0);
  missing_.assign(axes.size(), 0);
  for (std::vector<double>* of : {&change_, &way_, &moving_}) of->assign(axes.size(), 0.0);
}

const SampleSet* AxisGuard::push(const SampleSet& set) {
  const bool interrupted = waiting_ > 0 && set.index != held(0).index + 1;
  newest_ = (newest_ + 1) % kSlots;
  held(0).copy(set);
  ++waiting_;
  for (std::size_t a = 0; a < state_.size(); ++a) {
    if (interrupted) state_[a].run = 0;
    spikes_.push(static_cast<int>(a), set.accel[a], state_[a].smallest_step);
  }
  watch_changes();
  for (std::size_t a = 0; a < state_.size(); ++a) decide(a);
  if (newest_ == 0) learn_ratios();
  return waiting_ > kLookAhead ? give() : nullptr;
}

/// Judges the sound samples, the oldest first.
void AxisGuard::decide(std::size_t a) {
  const SpikeGuard::Decided decided =
      lone_spikes_ ? SpikeGuard::Decided{std::isnan(held(0).accel[a]) ? 0u : 1u, 0}
                   : spikes_.decide(static_cast<int>(a));
  if (!state_[a].axis.judged) return;
  if (decided.absurd != 0) take_out_absurd(a, decided.absurd);
  for (int age = decided.sound > 1 ? kLookAhead : 0; age >= 0; --age)
    if ((decided.sound >> age & 1u) != 0) judge(a, held(age).accel[a], age);
}

void AxisGuard::take_out_absurd(std::size_t a, unsigned ages) {
  for (int age = kLookAhead; age >= 0; --age)
    if ((ages >> age & 1u) != 0) remove(a, age, absurd_);
}

void AxisGuard::watch_step(State& s, double value) const {
  if (s.seen && value == s.last) {
    ++s.run;
    return;
  }
  if (s.seen) {
    const double change = std::abs(value - s.last);
    s.step += forget_ * (change - s.step);
    // A few far finer changes are other data, not the sensor's resolution.
    const bool far_finer = kFarFiner * change < s.smallest_step;
    s.finer = std::max(0, s.finer + (far_finer ? 1 : -1));
    if (s.smallest_step == 0 || (change < s.smallest_step && (!far_finer || s.finer > kFinerRun)))
      s.smallest_step = change;
  }
  s.still = s.paused = false;
  s.predicted = 0;
  s.run = 1;
  s.last = value;
  s.seen = true;
}

void AxisGuard::judge(std::size_t a, double value, int age) {
  State& s = state_[a];
  watch_step(s, value);
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (value > s.clips_at) s.clips_at = kNever;
  if (value < s.clips_below) s.clips_below = -kNever;
  const bool moving_fast = s.smallest_step > 0 && s.step > kMovingFast * s.smallest_step;

  const bool at_range = s.axis.range > 0 && std::abs(value) >= kFullScale * s.axis.range;
  const bool flat = s.run == kClippedRun && moving_fast;
  const bool flat_peak = flat && (value >= s.highest || value <= s.lowest);
  if (flat && value >= s.highest) s.clips_at = value;
  if (flat && value <= s.lowest) s.clips_below = value;
  s.highest = std::max(s.highest, value);
  s.lowest = std::min(s.lowest, value);
  if (at_range || value >= s.clips_at || value <= s.clips_below) {
    for (int back = flat_peak ? kClippedRun : 1; back >= 0; --back) remove(a, age + back, clipped_);
    s.after_clip = true;
    return;
  }
  if (s.after_clip) {
    remove(a, age, clipped_);
    s.after_clip = false;
  }

  judge_still(a, age);
}

/// Judges an axis whose newest sample may be one of several equal ones.
void AxisGuard::judge_still(std::size_t a, int age) {
  State& s = state_[a];
  if (s.run <= 1 && !s.still) return;
  if (s.paused && s.run >= long_run_) s.paused = false;
  if (s.still || s.paused) {
    remove(a, age, s.still ? stuck_ : missing_);
    return;
  }
  const double ratio = s.others > 0 ? s.own / s.others : 1;
  const double resolution = std::max(s.smallest_step, kFinest);
  const bool moved = s.smallest_step > 0 && s.step > kMovingFast * resolution;
  if (moved && age == 0 && s.run < long_run_) s.predicted += ratio * others(a, change_);
  const bool sudden = moved && s.run > kLookAhead && s.run < long_run_ &&
                      s.predicted > kMovingFast * kLookAhead * resolution;
  const bool lasting =
      s.run >= long_run_ && s.run % long_run_ == 0 && others_predict(a, ratio, resolution);
  s.still = sudden || lasting;
  s.paused = !s.still && moved && s.run == kLookAhead + 1 && age == 0 &&
             s.motion > kStrong * s.strongest && all_stopped(a);
  if (!s.still && !s.paused) return;
  for (int back = 0; back <= kLookAhead; ++back) remove(a, age + back, s.still ? stuck_ : missing_);
}

/// Returns true if the neighbors' motion of the last second predicts that the axis should move.
bool AxisGuard::others_predict(std::size_t a, double ratio, double resolution) {
  if (state_[a].smallest_step > 0) return ratio * others(a, moving_) > kOthersMove * resolution;
  // An axis that never changed has no step, so the finest step of its neighbors stands for it.
  double finest = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < state_.size(); ++b)
    if (neighbours(a, b) && moving_[b] > 0) finest = std::min(finest, state_[b].smallest_step);
  return others(a, moving_) > kOthersMove * std::max(finest, kFinest);
}

/// Updates the changes of every axis. Call it before removing any sample of this instant.
void AxisGuard::watch_changes() {
  std::fill(way_.begin(), way_.end(), 0.0);
  std::fill(change_.begin(), change_.end(), 0.0);
  for (int age = std::min(waiting_, kSlots) - 2; age >= 0; --age) {
    const double* const now = held(age).accel.data();
    const double* const before = held(age + 1).accel.data();
    for (std::size_t a = 0; a < state_.size(); ++a) {
      const double change = std::abs(now[a] - before[a]);
      change_[a] = change >= 0 ? change : 0;  // 0 for NaN
      way_[a] += change_[a];
    }
  }
  for (std::size_t a = 0; a < state_.size(); ++a) {
    State& s = state_[a];
    s.motion += forget_ * (change_[a] - s.motion);
    s.strongest = std::max(keep_strongest_ * s.strongest, s.motion);
    moving_[a] = s.run >= long_run_ / 2 || s.smallest_step == 0 ? 0 : s.motion;
  }
}

/// Learns how far an axis moves compared with its neighbors, while it moves.
void AxisGuard::learn_ratios() {
  for (std::size_t a = 0; a < state_.size(); ++a) {
    State& s = state_[a];
    if (!s.axis.judged || moving_[a] == 0 || s.run > kLookAhead) continue;
    s.own += forget_ratio_ * (s.motion - s.own);
    s.others += forget_ratio_ * (others(a, moving_) - s.others);
  }
}

bool AxisGuard::neighbours(std::size_t a, std::size_t b) const {
  return b != a && state_[b].axis.judged &&
         (alone_[a] != 0 || state_[b].axis.direction == state_[a].axis.direction);
}

/// Returns the median of `of` over the neighbors; 0 without neighbors.
double AxisGuard::others(std::size_t a, const std::vector<double>& of) {
  sorted_.clear();
  for (std::size_t b = 0; b < state_.size(); ++b)
    if (neighbours(a, b)) sorted_.push_back(of[b]);
  return upper_median(sorted_, 0);
}

/// Returns true if no neighbor has moved during the last kLookAhead changes.
bool AxisGuard::all_stopped(std::size_t a) const {
  for (std::size_t b = 0; b < state_.size(); ++b)
    if (neighbours(a, b) && way_[b] > 0) return false;
  return true;
}

void AxisGuard::remove(std::size_t a, int age, std::vector<std::int64_t>& counter) {
  if (age >= waiting_) return;
  double& value = held(age).accel[a];
  if (std::isnan(value)) return;
  value = kNaN;
  ++counter[a];
}

const SampleSet* AxisGuard::drain() {
  for (std::size_t a = 0; a < state_.size(); ++a)
    if (const unsigned absurd = spikes_.finish(static_cast<int>(a)).absurd; state_[a].axis.judged)
      take_out_absurd(a, absurd);
  return waiting_ > 0 ? give() : nullptr;
}

const SampleSet* AxisGuard::give() {
  out_.copy(held(waiting_ - 1));
  --waiting_;
  return &out_;
}

}  // namespace framewatch::estimator
