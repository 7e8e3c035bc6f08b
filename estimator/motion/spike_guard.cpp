#include "estimator/motion/spike_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace framewatch::estimator {
namespace {

constexpr unsigned kNewest = 1, kOldest = 1u << SpikeGuard::kLookAhead;
constexpr int kNeverStirred = 1000000;
constexpr double kRises = 1.3;  // times the first sample in doubt
constexpr double kNeverChanged = std::numeric_limits<double>::infinity();

}  // namespace

SpikeGuard::SpikeGuard(int axes, double rate_hz)
    : second_(std::max(2, static_cast<int>(std::lround(rate_hz)))),
      period_(std::max(2, static_cast<int>(std::lround(kPeriod_s * rate_hz)))),
      longest_(static_cast<int>(std::lround(kLongest_s * rate_hz))),
      axis_(static_cast<std::size_t>(axes)) {
  for (Axis& axis : axis_) axis.still = kNeverStirred;
}

bool SpikeGuard::beyond(const Axis& a, double value, double steps) const {
  const double reach = steps * std::max({a.step, a.step_before, a.least_step});
  return value > std::max(a.high, a.high_before) + reach ||
         value < std::min(a.low, a.low_before) - reach;
}

/// A value that stands still tells nothing, neither of a quiet sensor nor of a stuck one.
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

void SpikeGuard::see(int axis, double value, double finest) {
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
    if (other.still <= kStirring) return true;
    any = true;
  }
  return !any;  // alone, nothing contradicts it
}

/// The oldest first; returns the ages.
unsigned SpikeGuard::take_ages(Axis& a, unsigned ages) const {
  for (int age = kLookAhead; age >= 0; --age)
    if ((ages >> age & 1u) != 0) take(a, a.held[static_cast<std::size_t>(age)]);
  return ages;
}

/// Decides all that waits; what is in doubt is sound or not.
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

}  // namespace framewatch::estimator
