// StreamTimer while it has no clock model, and what makes it begin anew.
#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/can/stream_timer.h"

namespace framewatch::drivers {
namespace {

constexpr double kStart_us = 200'000;   ///< of frames make the first clock model, and
constexpr std::size_t kStartMost = 20;  ///< never more of them
constexpr std::size_t kStartLeast = 3;
constexpr double kApart_us = 2e6;   ///< host time and device time between two frames of one start
constexpr double kActive_us = 2e6;  ///< a stream without a frame for this long does not vote
constexpr double kSameStep_us = 50'000;  ///< by which two streams may see one step differently

}  // namespace

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

/// The frames held are the first ones of a new start; their numbers follow those before it.
void StreamTimer::start_anew() {
  starting_ = true;
  renumber_ = true;
  has_last_ = false;
  for (const Frame& frame : held_)
    if (frame.opens) set_last(frame);
}

/// So far each frame's number comes from the time since the one before it.
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
    // Which of the frames were stamped after the step is not known.
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
