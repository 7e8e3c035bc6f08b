#include "estimator/motion/axis_guard.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace framewatch::estimator {
namespace {

constexpr double kMemory_s = 1;       // of the mean step
constexpr double kLongRun_s = 0.5;    // equal samples that are stuck when the others move
constexpr double kMovingFast = 50;    // smallest steps per sample: equal samples are no accident
constexpr double kOthersMove = 10;    // the same of the other axes of the direction
constexpr double kFullScale = 0.999;  // of the configured range
constexpr int kClippedRun = 3;
constexpr double kFarFiner = 16;  // times smaller than the smallest step
constexpr int kFinerRun = 300;    // such changes that are believed

}  // namespace

AxisGuard::AxisGuard(const std::vector<Axis>& axes, double rate_hz, bool lone_spikes)
    : forget_(std::min(1.0, 1 / (kMemory_s * rate_hz))),
      long_run_(std::max(kLookAhead + 1, static_cast<int>(std::lround(kLongRun_s * rate_hz)))),
      lone_spikes_(lone_spikes),
      state_(axes.size()),
      spikes_(static_cast<int>(axes.size()), rate_hz),
      ring_(kSlots) {
  for (std::size_t a = 0; a < axes.size(); ++a) state_[a].axis = axes[a];
  for (SampleSet& set : ring_) set.accel.resize(axes.size());
  out_.accel.resize(axes.size());
  sorted_.reserve(axes.size());
  stuck_.assign(axes.size(), 0);
  clipped_.assign(axes.size(), 0);
  absurd_.assign(axes.size(), 0);
}

const SampleSet* AxisGuard::push(const SampleSet& set) {
  const bool interrupted = waiting_ > 0 && set.index != held(0).index + 1;
  newest_ = (newest_ + 1) % kSlots;
  SampleSet& slot = held(0);
  slot.time = set.time;
  slot.index = set.index;
  std::copy(set.accel.begin(), set.accel.end(), slot.accel.begin());
  ++waiting_;
  for (std::size_t a = 0; a < state_.size(); ++a) {
    if (interrupted) state_[a].run = 0;
    spikes_.see(static_cast<int>(a), set.accel[a], state_[a].smallest_step);
  }
  for (std::size_t a = 0; a < state_.size(); ++a) decide(a);
  return waiting_ > kLookAhead ? give() : nullptr;
}

/// Judges the samples that are sound, the oldest first.
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
    // Some far finer changes are another kind of number, not the sensor's resolution.
    const bool far_finer = kFarFiner * change < s.smallest_step;
    s.finer = std::max(0, s.finer + (far_finer ? 1 : -1));
    if (s.smallest_step == 0 || (change < s.smallest_step && (!far_finer || s.finer > kFinerRun)))
      s.smallest_step = change;
  }
  s.still = false;
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

  if (s.still) {
    remove(a, age, stuck_);
    return;
  }
  const bool sudden = moving_fast && s.run == kLookAhead + 1;
  const bool lasting = s.run >= long_run_ && s.run % long_run_ == 0 &&
                       others_moving(a) > kOthersMove * s.smallest_step;
  if (!sudden && !lasting) return;
  s.still = true;
  for (int back = 0; back <= kLookAhead; ++back) remove(a, age + back, stuck_);
}

/// Median over the other axes of the direction of their mean step: 0 when they stand still or the
/// axis is alone.
double AxisGuard::others_moving(std::size_t a) {
  sorted_.clear();
  double finest = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < state_.size(); ++b) {
    const State& other = state_[b];
    if (b == a || other.axis.direction != state_[a].axis.direction || !other.axis.judged) continue;
    const bool stands = other.run >= long_run_ || other.smallest_step == 0;
    sorted_.push_back(stands ? 0 : other.step);
    if (!stands) finest = std::min(finest, other.smallest_step);
  }
  if (sorted_.empty()) return 0;
  const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_.size() / 2);
  std::nth_element(sorted_.begin(), middle, sorted_.end());
  // An axis that never changed has no step of its own to compare with.
  return state_[a].smallest_step > 0 || *middle > kOthersMove * finest ? *middle : 0;
}

void AxisGuard::remove(std::size_t a, int age, std::vector<std::int64_t>& counter) {
  if (age >= waiting_) return;
  double& value = held(age).accel[a];
  if (std::isnan(value)) return;
  value = std::numeric_limits<double>::quiet_NaN();
  ++counter[a];
}

const SampleSet* AxisGuard::drain() {
  for (std::size_t a = 0; a < state_.size(); ++a)
    if (const unsigned absurd = spikes_.finish(static_cast<int>(a)).absurd; state_[a].axis.judged)
      take_out_absurd(a, absurd);
  return waiting_ > 0 ? give() : nullptr;
}

const SampleSet* AxisGuard::give() {
  const SampleSet& oldest = held(waiting_ - 1);
  out_.time = oldest.time;
  out_.index = oldest.index;
  std::copy(oldest.accel.begin(), oldest.accel.end(), out_.accel.begin());
  --waiting_;
  return &out_;
}

}  // namespace framewatch::estimator
