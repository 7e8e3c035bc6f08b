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
constexpr double kAbsurd_us = 2e6;       ///< nobody delivers so late whose patience is not longer
constexpr std::int64_t kNoJump = 3;      ///< numbers
constexpr double kStall_us = 1e6;        ///< frames may be late by after an outage, and
constexpr double kStallOfWrap = 0.125;   ///< not more of the counter: a restart would look like it
constexpr double kSlew = 0.002;          ///< that times may run faster or slower by than the line
constexpr double kActive_us = 2e6;       ///< a stream without a frame for so long does not vote
/// Of a period, that a frame may come before a line that is well known; one that is not: of few
/// stamps, or long ago.
constexpr double kShare = 0.05, kVagueShare = 0.25;
constexpr std::int64_t kFewStamps = 256;
constexpr double kLongAgo = 100;  ///< periods

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
    return last_device_us_ + period_us * std::round((host_us - last_host_us_) / period_us);
  }
  const double device_us = reading * settings_.tick_us + origin_us_;
  const double wrap_us = settings_.modulus * settings_.tick_us;
  if (wrap_us <= 0 || !any_) return device_us;
  const double expected_us = last_device_us_ + (host_us - last_host_us_) / line_.rate();
  return device_us + wrap_us * std::round((expected_us - device_us) / wrap_us);
}

bool StreamTimer::believable(double late_us) const {
  return late_us >= std::min(kEarliest_us, -settings_.period_us / 2) &&
         late_us <= std::max(kLatest_us, 1.5 * settings_.period_us);
}

double StreamTimer::absurd_us() const {
  return std::max(kAbsurd_us, settings_.patience_us);
}

/// Nothing restarted: a starved sender or adapter, a line begun with late frames, or an outage that
/// ends with a burst.
bool StreamTimer::goes_on(const Held& held) const {
  const std::int64_t jump = held.values.number - delivered_;
  const double late = late_us(held);
  if (jump <= 0) return false;
  if (jump <= kNoJump) return late > -kLatest_us && late < absurd_us();
  const double wrap_us = settings_.modulus * settings_.tick_us;
  return late >= 0 && late < kStall_us && (wrap_us <= 0 || late < kStallOfWrap * wrap_us);
}

/// On the line, but without its jumps: who takes equal steps shall not see one when the line is
/// found to be lower.
double StreamTimer::time_of(double device_us) {
  const double line_us = line_.host_us(device_us);
  const double step_us = device_us - told_device_us_;
  const double free_us = kSlew * std::max(0.0, step_us);
  const double on_us = told_us_ + step_us * line_.rate();
  const double time_us =
      told_any_ ? on_us + std::clamp(line_us - on_us, -free_us, free_us) : line_us;
  if (!told_any_ || step_us > 0) {
    told_any_ = true;
    told_device_us_ = device_us;
    told_us_ = time_us;
  }
  return time_us;
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
  if (settings_.kind == CanTiming::period && !starting_)
    return see_arrival(host_us, std::move(values));
  const double device_us = device_of(reading, host_us);
  values.number =
      any_ ? last_number_ + std::llround((device_us - last_device_us_) / settings_.period_us)
           : last_number_;
  opened_ = {device_us, host_us, false, {values.node, values.message, values.number, {}}};
  take({device_us, host_us, true, std::move(values)});
}

void StreamTimer::see_arrival(double host_us, TimedValues values) {
  const double since = (host_us - line_.host_us(last_device_us_)) / period_us();
  arrivals_.add(since, seen_ < kFewStamps || since > kLongAgo ? kVagueShare : kShare);
  values.number = last_number_ + arrivals_.newest();
  opened_ = {0, host_us, false, {values.node, values.message, values.number, {}}};
  unnumbered_.push_back({0, host_us, true, std::move(values)});
  if (arrivals_.settled()) give_numbers();
}

bool StreamTimer::confirm(std::int64_t number) {
  if (settings_.kind != CanTiming::period) return decide(number - opened_.values.number);
  if (number == opened_.values.number && !arrivals_.waiting()) return true;
  if (!arrivals_.confirm(number - last_number_)) return false;
  give_numbers();
  return true;
}

/// The numbers of the frames held are larger by `shift`.
bool StreamTimer::decide(std::int64_t shift) {
  if (starting_) return shift == 0;
  if (!opened_is_held_) return shift == 0 || unwrap(shift);
  const double shift_us = settings_.period_us * static_cast<double>(shift);
  const double late = opened_.host_us - line_.host_us(opened_.device_us + shift_us);
  if (held_.front().values.number + shift <= delivered_ || late <= -kLatest_us ||
      late >= absurd_us())
    return shift == 0;
  origin_us_ += shift_us;
  opened_.device_us += shift_us;
  opened_.values.number += shift;
  for (Held& h : held_) {
    h.device_us += shift_us;
    h.values.number += shift;
  }
  go_on_late();
  return true;
}

/// The frame seen last was late by whole wraps of its reading, which made it look in time.
bool StreamTimer::unwrap(std::int64_t shift) {
  const double shift_us = settings_.period_us * static_cast<double>(shift);
  if (shift >= 0 || settings_.modulus <= 0 ||
      std::remainder(shift_us / settings_.tick_us, settings_.modulus) != 0)
    return false;
  opened_.device_us += shift_us;
  opened_.values.number += shift;
  last_device_us_ = opened_.device_us;
  last_number_ = delivered_ = opened_.values.number;
  return true;
}

void StreamTimer::give_numbers() {
  const std::vector<std::int64_t> numbers = arrivals_.settle();
  std::vector<Held> unnumbered = std::exchange(unnumbered_, {});
  const std::int64_t number0 = last_number_;
  const double device0_us = last_device_us_;
  std::size_t next = 0;
  for (Held& held : unnumbered) {
    if (!held.timed) {
      attach(std::move(held.values));
      continue;
    }
    const std::int64_t number = numbers[next++];
    held.values.number = number0 + number;
    held.device_us = device0_us + settings_.period_us * static_cast<double>(number);
    opened_ = {held.device_us,
               held.host_us,
               false,
               {held.values.node, held.values.message, held.values.number, {}}};
    take(std::move(held));
  }
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
  const bool explained = settings_.kind == CanTiming::period && late >= 0;
  if (!explained && !believable(late) && !(late < 0 && goes_on(held))) return hold(std::move(held));
  if (!held_.empty()) give_out_held();
  late_ = false;
  opened_is_held_ = false;
  line_.add(held.device_us, held.host_us);
  ++seen_;
  remember(held);
  delivered_ = std::max(delivered_, held.values.number);
  deliver_(held.values, time_of(held.device_us));
}

void StreamTimer::attach(TimedValues values) {
  if (!unnumbered_.empty()) {
    unnumbered_.push_back({0, 0, false, std::move(values)});
    return;
  }
  values.number = opened_.values.number;
  if (opened_is_held_) {
    held_.push_back({opened_.device_us, opened_.host_us, false, std::move(values)});
    return;
  }
  deliver_(values, time_of(opened_.device_us));
}

bool StreamTimer::attach_earlier(TimedValues values) {
  if (!unnumbered_.empty()) return false;
  const auto opened = std::find_if(held_.begin(), held_.end(), [&](const Held& h) {
    return h.timed && h.values.number == values.number;
  });
  if (opened != held_.end()) {
    const Held more{opened->device_us, opened->host_us, false, std::move(values)};
    held_.insert(opened + 1, more);
    return true;
  }
  if (starting_) return false;
  const auto before = static_cast<double>(opened_.values.number - values.number);
  deliver_(values, time_of(opened_.device_us - before * settings_.period_us));
  return true;
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
  if (!late_ && goes_on(held_.front())) return go_on_late();
  late_ = false;
  ++restarts_;
  start_anew();
}

/// The frames held are not a new start, only late, and those after them may be so for a while.
void StreamTimer::go_on_late() {
  late_ = true;
  patience_ = static_cast<int>(settings_.patience_us / settings_.period_us);
  give_out_held();
}

/// The frames held are late, or nonsense.
void StreamTimer::give_out_held() {
  std::vector<Held> held = std::exchange(held_, {});
  for (Held& h : held) {
    if (std::abs(late_us(h)) > absurd_us()) {
      unplaced_ += h.timed;
      continue;
    }
    if (h.timed) remember(h);
    delivered_ = std::max(delivered_, h.values.number);
    deliver_(h.values, time_of(h.device_us));
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

/// Their numbers so far come from the distance to the one before.
void StreamTimer::number_first() {
  std::vector<double> arrivals;
  for (const Held& h : held_)
    if (h.timed) arrivals.push_back((h.host_us - held_.front().host_us) / settings_.period_us);
  const std::vector<std::int64_t> numbers = first_numbers(arrivals);
  const Held first = held_.front();
  std::size_t next = 0;
  std::int64_t number = 0;
  for (Held& h : held_) {
    if (h.timed) number = numbers[next++];
    h.values.number = first.values.number + number;
    h.device_us = first.device_us + settings_.period_us * static_cast<double>(number);
    if (h.timed) remember(h);
  }
  opened_.values.number = held_.back().values.number;
  opened_.device_us = held_.back().device_us;
}

void StreamTimer::settle() {
  if (settings_.kind == CanTiming::period && !held_.empty()) {
    any_ = false;
    number_first();
  }
  starting_ = false;
  seen_ = 0;
  told_any_ = false;
  std::vector<Held> held = std::exchange(held_, {});
  if (held.empty()) return;
  std::stable_sort(held.begin(), held.end(),
                   [](const Held& a, const Held& b) { return a.values.number < b.values.number; });
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
    deliver_(h.values, time_of(h.device_us));
  }
}

void StreamTimer::restart() {
  give_numbers();
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
    arrivals_ = {};
    unnumbered_.clear();
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
    deliver_(h.values, time_of(h.device_us));
  }
  opened_is_held_ = false;
}

void StreamTimer::finish() {
  give_numbers();
  if (starting_)
    settle();
  else
    give_out_held();
}

}  // namespace framewatch::drivers
