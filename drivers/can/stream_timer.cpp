#include "drivers/can/stream_timer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace framewatch::drivers {
namespace {

constexpr double kStart_us = 200'000;   ///< of frames before the first line, and
constexpr std::size_t kStartMost = 20;  ///< never more of them
constexpr std::size_t kStartLeast = 3;
constexpr std::size_t kSure = 5;         ///< frames that agree make a step
constexpr double kEarliest_us = -5'000;  ///< before the line: nothing is received before it is sent
constexpr double kLatest_us = 30'000;    ///< a busy bus
constexpr double kSame_us = 20'000;      ///< what two frames of one step may differ by
constexpr double kAbsurd_us = 2e6;       ///< nobody delivers so late
constexpr int kPatience = 100;           ///< late frames without a jump before they are a new start
constexpr std::int64_t kNoJump = 3;      ///< numbers
constexpr double kActive_us = 2e6;       ///< a stream without a frame for so long does not vote
/// Of a period, that a frame may come before the line; after it the rest.
constexpr double kEarlyShare = 0.25;

}  // namespace

bool HostSteps::resolve(double step_us, double now_us) {
  int active = 0, same = 0;
  for (const StreamTimer* t : timers_) {
    if (t->settings_.kind == CanTiming::period || now_us - t->last_host_us_ > kActive_us) continue;
    ++active;
    if (t->starting_ || t->held_.empty()) continue;
    const auto last = std::find_if(t->held_.rbegin(), t->held_.rend(),
                                   [](const StreamTimer::Held& h) { return h.timed; });
    same +=
        last != t->held_.rend() && std::abs(t->late_us(*last) - step_us) < kSame_us + kLatest_us;
  }
  if (same < 2 || 2 * same < active) return false;
  total_us_ += step_us;
  ++count_;
  for (StreamTimer* t : timers_) t->shift(step_us);
  return true;
}

StreamTimer::StreamTimer(const Settings& settings, HostSteps& steps)
    : settings_(settings), steps_(steps) {
  steps_.join(*this);
}

/// Device time of a frame that opens a sample; wraps are told by the host time since the last one.
double StreamTimer::device_of(double reading, double host_us) const {
  const double period_us = settings_.period_us;
  if (settings_.kind == CanTiming::period) {
    if (!any_) return last_device_us_ + period_us;
    if (starting_)
      return last_device_us_ + period_us * std::round((host_us - last_host_us_) / period_us);
    const double since = host_us - line_.host_us(last_device_us_);
    return last_device_us_ +
           period_us * std::floor(since / (period_us * line_.rate()) + kEarlyShare);
  }
  const double device_us = reading * settings_.tick_us;
  const double wrap_us = settings_.modulus * settings_.tick_us;
  if (wrap_us <= 0 || !any_) return device_us;
  const double expected_us = last_device_us_ + (host_us - last_host_us_) / line_.rate();
  return device_us + wrap_us * std::round((expected_us - device_us) / wrap_us);
}

bool StreamTimer::believable(double late_us) const {
  return late_us >= std::min(kEarliest_us, -settings_.period_us / 2) &&
         late_us <= std::max(kLatest_us, 1.5 * settings_.period_us);
}

/// Nothing restarted: a starved sender or adapter, or a line begun with late frames.
bool StreamTimer::goes_on(const Held& held) const {
  const std::int64_t jump = held.values.number - delivered_;
  const double late = late_us(held);
  return jump > 0 && jump <= kNoJump && late > -kLatest_us && late < kAbsurd_us;
}

std::size_t StreamTimer::timed_held() const {
  return static_cast<std::size_t>(
      std::count_if(held_.begin(), held_.end(), [](const Held& h) { return h.timed; }));
}

void StreamTimer::remember(const Held& held) {
  if (any_ && held.values.number <= last_number_) return;
  any_ = true;
  last_device_us_ = held.device_us;
  last_host_us_ = held.host_us;
  last_number_ = held.values.number;
}

void StreamTimer::see(double reading, double host_us, TimedValues values) {
  const double device_us = device_of(reading, host_us);
  values.number =
      any_ ? last_number_ + std::llround((device_us - last_device_us_) / settings_.period_us)
           : last_number_;
  opened_ = {device_us, host_us, false, {values.node, values.message, values.number, {}}};
  take({device_us, host_us, true, std::move(values)});
}

void StreamTimer::take(Held held) {
  opened_is_held_ = true;
  if (starting_) {
    // A line is begun with frames that belong together.
    if (!held_.empty()) {
      const double apart_us = (held.host_us - last_host_us_) - (held.device_us - last_device_us_);
      if (std::abs(apart_us) > kAbsurd_us) {
        unplaced_ += static_cast<std::int64_t>(timed_held());
        held_.clear();
        any_ = false;
      }
    }
    remember(held);
    held_.push_back(std::move(held));
    const auto wanted = std::clamp(static_cast<std::size_t>(kStart_us / settings_.period_us),
                                   kStartLeast, kStartMost);
    if (timed_held() >= wanted) settle();
    return;
  }
  const double late = late_us(held);
  if (!believable(late) && !(late < 0 && goes_on(held))) return hold(std::move(held));
  if (!held_.empty()) give_out_held();
  late_ = false;
  opened_is_held_ = false;
  line_.add(held.device_us, held.host_us);
  remember(held);
  delivered_ = std::max(delivered_, held.values.number);
  deliver_(held.values, line_.host_us(held.device_us));
}

void StreamTimer::attach(TimedValues values) {
  values.number = opened_.values.number;
  if (opened_is_held_) {
    held_.push_back({opened_.device_us, opened_.host_us, false, std::move(values)});
    return;
  }
  deliver_(values, line_.host_us(opened_.device_us));
}

void StreamTimer::hold(Held held) {
  const double late = late_us(held);
  if (!held_.empty() && std::abs(late_us(held_.front()) - late) > kSame_us) give_out_held();
  const bool wait = late_ && patience_ > 0 && goes_on(held);
  held_.push_back(std::move(held));
  if (wait) {
    --patience_;
    return give_out_held();
  }
  if (timed_held() < kSure) return;
  double step_us = late;
  for (const Held& h : held_)
    if (h.timed) step_us = std::min(step_us, late_us(h));
  const double now_us = held_.back().host_us;
  if (steps_.resolve(step_us, now_us)) return;
  if (!late_ && goes_on(held_.front())) {
    late_ = true;
    patience_ = kPatience;
    return give_out_held();
  }
  late_ = false;
  ++restarts_;
  start_anew();
}

/// The frames held are late, or nonsense.
void StreamTimer::give_out_held() {
  std::vector<Held> held = std::exchange(held_, {});
  for (Held& h : held) {
    if (std::abs(late_us(h)) > kAbsurd_us) {
      unplaced_ += h.timed;
      continue;
    }
    if (h.timed) remember(h);
    delivered_ = std::max(delivered_, h.values.number);
    deliver_(h.values, line_.host_us(h.device_us));
  }
  opened_is_held_ = false;
}

/// The frames held are the first of a new start: their numbers go on where the last one ended.
void StreamTimer::start_anew() {
  starting_ = true;
  renumber_ = true;
  any_ = false;
  for (const Held& h : held_)
    if (h.timed) remember(h);
}

void StreamTimer::settle() {
  starting_ = false;
  std::vector<Held> held = std::exchange(held_, {});
  if (held.empty()) return;
  const std::int64_t shift =
      std::exchange(renumber_, false) ? delivered_ + 1 - held.front().values.number : 0;
  last_number_ += shift;
  opened_.values.number += shift;
  opened_is_held_ = false;
  bool first = true;
  for (const Held& h : held) {
    if (!h.timed) continue;
    if (std::exchange(first, false)) line_.start(h.device_us, h.host_us);
    line_.add(h.device_us, h.host_us);
  }
  for (Held& h : held) {
    h.values.number += shift;
    delivered_ = std::max(delivered_, h.values.number);
    deliver_(h.values, line_.host_us(h.device_us));
  }
}

void StreamTimer::restart() {
  if (starting_) {
    held_.clear();
    any_ = false;
    return;
  }
  give_out_held();
  ++restarts_;
  start_anew();
}

void StreamTimer::shift(double step_us) {
  if (starting_ || settings_.kind == CanTiming::period) {
    // It cannot tell which of its frames were stamped after the step.
    if (!starting_) start_anew();
    held_.clear();
    any_ = false;
    return;
  }
  last_host_us_ = line_.host_us(last_device_us_);
  line_.start(last_device_us_, last_host_us_);
  std::vector<Held> held = std::exchange(held_, {});
  for (Held& h : held) {
    h.host_us -= step_us;
    if (!h.timed || !believable(late_us(h))) continue;
    line_.add(h.device_us, h.host_us);
    remember(h);
  }
  for (const Held& h : held) {
    delivered_ = std::max(delivered_, h.values.number);
    deliver_(h.values, line_.host_us(h.device_us));
  }
  opened_is_held_ = false;
}

void StreamTimer::finish() {
  if (starting_)
    settle();
  else
    give_out_held();
}

}  // namespace framewatch::drivers
