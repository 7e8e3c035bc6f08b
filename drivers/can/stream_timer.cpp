// SPDX-License-Identifier: MIT
#include "drivers/can/stream_timer.h"

#include <algorithm>
#include <cmath>

namespace framewatch::drivers {
namespace {

constexpr std::size_t kAgreeing = 5;  ///< held frames that must agree for a decision
constexpr double kEarliest_us =
    -5'000;  ///< before the clock model: frames arrive after they were sent
constexpr double kLatest_us = 30'000;   ///< after it, on a busy bus
constexpr double kSame_us = 20'000;     ///< by which the lateness of held frames may differ
constexpr double kMaxLate_us = 2e6;     ///< of a late frame, unless `patience_us` is longer
constexpr std::int64_t kNoJump = 3;     ///< numbers
constexpr double kStall_us = 1e6;       ///< lateness of frames that follow an outage, and
constexpr double kStallOfWrap = 0.125;  ///< of the counter's range: a restart looks like more
/// Periods by which a frame may come before its due time: with a good clock model, and with one
/// from few frames or from long ago.
constexpr double kTolerance = 0.05, kVagueTolerance = 0.25;
constexpr std::int64_t kFewFrames = 256;
constexpr double kLongAgo = 100;  ///< periods

// For the start, before there is a clock model:
constexpr double kStart_us = 200'000;   ///< of frames make the first clock model,
constexpr std::size_t kStartMost = 20;  ///< but at most this many
constexpr std::size_t kStartLeast = 3;
constexpr double kApart_us =
    2e6;  ///< largest difference of host and device time between two frames of one start
constexpr double kActive_us = 2e6;       ///< a stream without a frame for this long does not vote
constexpr double kSameStep_us = 50'000;  ///< by which two streams may see one step differently

}  // namespace

bool HostClockSteps::resolve(double step_us, double now_us) {
  int active = 0, same = 0;
  for (const StampedStream* stream : streams_) {
    const StampedStream::Vote vote = stream->vote(step_us, now_us);
    active += vote != StampedStream::Vote::abstains;
    same += vote == StampedStream::Vote::yes;
  }
  if (same < 2 || 2 * same < active) return false;
  total_us_ += step_us;
  ++count_;
  for (StampedStream* stream : streams_) stream->shift(step_us);
  return true;
}

StreamTimer::StreamTimer(const Settings& settings, HostClockSteps& steps)
    : settings_(settings), steps_(steps) {
  steps_.join(*this);
}

/// Returns the device time of a reading. The host time since the last frame tells how often it
/// wrapped.
double StreamTimer::device_time_us(double reading, double host_us) const {
  const double period_us = settings_.period_us;
  if (settings_.kind == CanTiming::period) {
    if (!has_last_) return last_device_us_ + period_us;
    return last_device_us_ + period_us * std::round((host_us - last_host_us_) / period_us);
  }
  const double device_us = reading * settings_.tick_us + origin_us_;
  const double wrap_us = settings_.modulus * settings_.tick_us;
  if (wrap_us <= 0 || !has_last_) return device_us;
  const double expected_us = last_device_us_ + (host_us - last_host_us_) / clock_.rate();
  return device_us + wrap_us * std::round((expected_us - device_us) / wrap_us);
}

bool StreamTimer::fits(double late_us) const {
  return late_us >= std::min(kEarliest_us, -settings_.period_us / 2) &&
         late_us <= std::max(kLatest_us, 1.5 * settings_.period_us);
}

double StreamTimer::most_late_us() const {
  return std::max(kMaxLate_us, settings_.patience_us);
}

/// Returns true if a frame is explained without a restart: the sender or the adapter was delayed,
/// the clock model began with late frames, or an outage ends with a burst.
bool StreamTimer::continues(const Frame& frame) const {
  const std::int64_t jump = frame.values.number - newest_number_;
  const double late = late_us(frame);
  if (jump <= 0) return false;
  if (jump <= kNoJump) return late > -kLatest_us && late < most_late_us();
  const double wrap_us = settings_.modulus * settings_.tick_us;
  return late >= 0 && late < kStall_us && (wrap_us <= 0 || late < kStallOfWrap * wrap_us);
}

double StreamTimer::time_of(double device_us) {
  return slew_.follow(device_us, clock_.host_us(device_us), clock_.rate());
}

std::size_t StreamTimer::samples_held() const {
  return static_cast<std::size_t>(
      std::count_if(held_.begin(), held_.end(), [](const Frame& f) { return f.opens; }));
}

void StreamTimer::set_last(const Frame& frame) {
  if (has_last_ && frame.values.number <= last_number_) return;
  has_last_ = true;
  last_device_us_ = frame.device_us;
  last_host_us_ = frame.host_us;
  last_number_ = frame.values.number;
}

void StreamTimer::deliver(const Frame& frame) {
  newest_number_ = std::max(newest_number_, frame.values.number);
  deliver_(frame.values, time_of(frame.device_us));
}

void StreamTimer::open_sample(double reading, double host_us, TimedValues values) {
  if (settings_.kind == CanTiming::period && !starting_)
    return open_by_arrival(host_us, std::move(values));
  const double device_us = device_time_us(reading, host_us);
  values.number =
      has_last_ ? last_number_ + std::llround((device_us - last_device_us_) / settings_.period_us)
                : last_number_;
  opened_ = {device_us, host_us, false, {values.node, values.message, values.number, {}}};
  accept({device_us, host_us, true, std::move(values)});
}

void StreamTimer::open_by_arrival(double host_us, TimedValues values) {
  const double since = (host_us - clock_.host_us(last_device_us_)) / period_us();
  const bool vague = clock_frames_ < kFewFrames || since > kLongAgo;
  arrivals_.add(since, vague ? kVagueTolerance : kTolerance);
  values.number = last_number_ + arrivals_.newest();
  opened_ = {0, host_us, false, {values.node, values.message, values.number, {}}};
  unnumbered_.push_back({0, host_us, true, std::move(values)});
  if (arrivals_.unambiguous()) number_by_arrival();
}

void StreamTimer::number_by_arrival() {
  const std::vector<std::int64_t> numbers = arrivals_.assign_numbers();
  std::vector<Frame> unnumbered = std::exchange(unnumbered_, {});
  const std::int64_t number0 = last_number_;
  const double device0_us = last_device_us_;
  std::size_t next = 0;
  for (Frame& frame : unnumbered) {
    if (!frame.opens) {
      attach(std::move(frame.values));
      continue;
    }
    const std::int64_t number = numbers[next++];
    frame.values.number = number0 + number;
    frame.device_us = device0_us + settings_.period_us * static_cast<double>(number);
    opened_ = {frame.device_us,
               frame.host_us,
               false,
               {frame.values.node, frame.values.message, frame.values.number, {}}};
    accept(std::move(frame));
  }
}

bool StreamTimer::confirm(std::int64_t number) {
  if (settings_.kind != CanTiming::period) return shift_numbers(number - opened_.values.number);
  if (number == opened_.values.number && !arrivals_.waiting()) return true;
  if (!arrivals_.confirm(number - last_number_)) return false;
  number_by_arrival();
  return true;
}

/// Adds `shift` to the numbers of the held frames. Returns false when they cannot have these
/// numbers.
bool StreamTimer::shift_numbers(std::int64_t shift) {
  if (starting_) return shift == 0;
  if (!opened_is_held_) return shift == 0 || undo_wraps(shift);
  const double shift_us = settings_.period_us * static_cast<double>(shift);
  const double late = opened_.host_us - clock_.host_us(opened_.device_us + shift_us);
  if (held_.front().values.number + shift <= newest_number_ || late <= -kLatest_us ||
      late >= most_late_us())
    return shift == 0;
  origin_us_ += shift_us;
  opened_.device_us += shift_us;
  opened_.values.number += shift;
  for (Frame& frame : held_) {
    frame.device_us += shift_us;
    frame.values.number += shift;
  }
  go_on_late();
  return true;
}

/// Corrects a frame that seemed to fit because it was late by whole wraps of its reading.
bool StreamTimer::undo_wraps(std::int64_t shift) {
  const double shift_us = settings_.period_us * static_cast<double>(shift);
  if (shift >= 0 || settings_.modulus <= 0 ||
      std::remainder(shift_us / settings_.tick_us, settings_.modulus) != 0)
    return false;
  opened_.device_us += shift_us;
  opened_.values.number += shift;
  last_device_us_ = opened_.device_us;
  last_number_ = newest_number_ = opened_.values.number;
  return true;
}

void StreamTimer::accept(Frame frame) {
  opened_is_held_ = true;
  if (starting_) return hold_until_started(std::move(frame));
  const double late = late_us(frame);
  const bool numbered_late = settings_.kind == CanTiming::period && late >= 0;
  if (!numbered_late && !fits(late) && !(late < 0 && continues(frame)))
    return hold(std::move(frame));
  if (!held_.empty()) deliver_held();
  late_ = false;
  opened_is_held_ = false;
  clock_.add(frame.device_us, frame.host_us);
  ++clock_frames_;
  set_last(frame);
  deliver(frame);
}

void StreamTimer::hold(Frame frame) {
  const double late = late_us(frame);
  if (!held_.empty() && std::abs(late_us(held_.front()) - late) > kSame_us) deliver_held();
  const bool deliver_late = late_ && late_frames_left_ > 0 && continues(frame);
  held_.push_back(std::move(frame));
  if (deliver_late) {
    --late_frames_left_;
    return deliver_held();
  }
  if (samples_held() < kAgreeing) return;
  double step_us = late;
  for (const Frame& f : held_)
    if (f.opens) step_us = std::min(step_us, late_us(f));
  const double now_us = held_.back().host_us;
  if (steps_.resolve(step_us, now_us)) return;
  if (!late_ && continues(held_.front())) return go_on_late();
  late_ = false;
  ++restarts_;
  start_anew();
}

/// Delivers the held frames, which are late without a restart; the next frames may be late too.
void StreamTimer::go_on_late() {
  late_ = true;
  late_frames_left_ = static_cast<int>(settings_.patience_us / settings_.period_us);
  deliver_held();
}

/// Delivers the held frames as late, and drops those without a plausible time.
void StreamTimer::deliver_held() {
  const std::vector<Frame> held = std::exchange(held_, {});
  for (const Frame& frame : held) {
    if (std::abs(late_us(frame)) > most_late_us()) {
      unplaced_ += frame.opens;
      continue;
    }
    if (frame.opens) set_last(frame);
    deliver(frame);
  }
  opened_is_held_ = false;
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
  const auto opened = std::find_if(held_.begin(), held_.end(), [&](const Frame& frame) {
    return frame.opens && frame.values.number == values.number;
  });
  if (opened != held_.end()) {
    const Frame more{opened->device_us, opened->host_us, false, std::move(values)};
    held_.insert(opened + 1, more);
    return true;
  }
  if (starting_) return false;
  const auto before = static_cast<double>(opened_.values.number - values.number);
  deliver_(values, time_of(opened_.device_us - before * settings_.period_us));
  return true;
}

void StreamTimer::finish() {
  number_by_arrival();
  if (starting_)
    finish_start();
  else
    deliver_held();
}

void StreamTimer::hold_until_started(Frame frame) {
  if (!held_.empty()) {
    const double apart_us = (frame.host_us - last_host_us_) - (frame.device_us - last_device_us_);
    if (std::abs(apart_us) > kApart_us) {
      unplaced_ += static_cast<std::int64_t>(samples_held());
      held_.clear();
      has_last_ = false;
    }
  }
  set_last(frame);
  held_.push_back(std::move(frame));
  const auto wanted = std::clamp(static_cast<std::size_t>(kStart_us / settings_.period_us),
                                 kStartLeast, kStartMost);
  if (samples_held() >= wanted) finish_start();
}

/// Begins a new start with the held frames; their numbers continue those before it.
void StreamTimer::start_anew() {
  starting_ = true;
  renumber_ = true;
  has_last_ = false;
  for (const Frame& frame : held_)
    if (frame.opens) set_last(frame);
}

/// Numbers the first frames together; so far each number came from the time since the frame before.
void StreamTimer::number_first_frames() {
  std::vector<double> arrivals;
  for (const Frame& frame : held_)
    if (frame.opens)
      arrivals.push_back((frame.host_us - held_.front().host_us) / settings_.period_us);
  const std::vector<std::int64_t> numbers = first_numbers(arrivals);
  const Frame first = held_.front();
  std::size_t next = 0;
  std::int64_t number = 0;
  for (Frame& frame : held_) {
    if (frame.opens) number = numbers[next++];
    frame.values.number = first.values.number + number;
    frame.device_us = first.device_us + settings_.period_us * static_cast<double>(number);
    if (frame.opens) set_last(frame);
  }
  opened_.values.number = held_.back().values.number;
  opened_.device_us = held_.back().device_us;
}

void StreamTimer::finish_start() {
  if (settings_.kind == CanTiming::period && !held_.empty()) {
    has_last_ = false;
    number_first_frames();
  }
  starting_ = false;
  clock_frames_ = 0;
  slew_.reset();
  std::vector<Frame> held = std::exchange(held_, {});
  if (held.empty()) return;
  std::stable_sort(held.begin(), held.end(), [](const Frame& a, const Frame& b) {
    return a.values.number < b.values.number;
  });
  const std::int64_t shift =
      std::exchange(renumber_, false) ? newest_number_ + 1 - held.front().values.number : 0;
  last_number_ += shift;
  opened_.values.number += shift;
  opened_is_held_ = false;
  bool first = true;
  for (const Frame& frame : held) {
    if (!frame.opens) continue;
    if (std::exchange(first, false)) clock_.start(frame.device_us, frame.host_us);
    clock_.add(frame.device_us, frame.host_us);
  }
  for (Frame& frame : held) {
    frame.values.number += shift;
    deliver(frame);
  }
}

void StreamTimer::restart() {
  number_by_arrival();
  if (starting_) {
    held_.clear();
    has_last_ = false;
    return;
  }
  deliver_held();
  ++restarts_;
  start_anew();
}

StampedStream::Vote StreamTimer::vote(double step_us, double now_us) const {
  if (settings_.kind == CanTiming::period || now_us - last_host_us_ > kActive_us)
    return Vote::abstains;
  if (starting_ || held_.empty()) return Vote::no;
  const auto last =
      std::find_if(held_.rbegin(), held_.rend(), [](const Frame& frame) { return frame.opens; });
  const bool same = last != held_.rend() && std::abs(late_us(*last) - step_us) < kSameStep_us;
  return same ? Vote::yes : Vote::no;
}

void StreamTimer::shift(double step_us) {
  if (starting_ || settings_.kind == CanTiming::period) {
    // It is unknown which of the frames were stamped after the step.
    arrivals_ = {};
    unnumbered_.clear();
    if (!starting_) start_anew();
    held_.clear();
    has_last_ = false;
    return;
  }
  last_host_us_ = clock_.host_us(last_device_us_);
  clock_.start(last_device_us_, last_host_us_);
  std::vector<Frame> held = std::exchange(held_, {});
  for (Frame& frame : held) {
    frame.host_us -= step_us;
    if (!frame.opens || !fits(late_us(frame))) continue;
    clock_.add(frame.device_us, frame.host_us);
    set_last(frame);
  }
  for (const Frame& frame : held) deliver(frame);
  opened_is_held_ = false;
}

}  // namespace framewatch::drivers
