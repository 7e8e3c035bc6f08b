// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimation/stamp_events.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/usual_time.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/events/warning_event.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kFirstStampId = std::int64_t{1} << 44, kClockId = std::int64_t{1} << 45;
/// Distance from the others' instants, in instants, at which SampleMerger leaves samples out.
constexpr double kOffGrid = 0.3;
/// Share of the rate by which a second may have more samples. More are another rate (of_rate).
constexpr double kMoreOften = 0.2;
constexpr double kFew = 3, kMost_ratio = 0.01;  ///< samples beyond both are another rate

double seconds_between(std::int64_t from_us, std::int64_t to_us) {
  return 1e-6 * (static_cast<double>(to_us) - static_cast<double>(from_us));
}

std::string length(double seconds) {
  const double s = std::abs(seconds);
  if (s < 300) return fmt::format("{:.1f} s", s);
  if (s < 172'800) return fmt::format("{:.1f} h", s / 3600);
  return fmt::format("{:.0f} days", s / 86'400);
}

}  // namespace

StampEvents::StampEvents(const std::vector<estimator::SensorAxis>& axes,
                         const estimator::EstimatorOptions& options)
    : axes_(axes),
      rate_hz_(options.rate_hz),
      lateness_s_(options.lateness_s),
      channels_(axes.size()) {}

void StampEvents::sample(const estimator::AccelSample& s) {
  if (s.axis < 0 || static_cast<std::size_t>(s.axis) >= channels_.size()) return;
  Channel& c = channels_[static_cast<std::size_t>(s.axis)];
  c.newest_us = to_microseconds(s.time);
  if (c.samples++ == 0) c.first_us = c.newest_us;
  ++c.came;
}

std::vector<event_t> StampEvents::update(const std::vector<std::int64_t>& lost,
                                         std::int64_t time_us) {
  std::vector<std::int64_t> stamps_us;
  for (const Channel& c : channels_) stamps_us.push_back(c.came > 0 ? c.newest_us : INT64_MIN);
  const auto median_us = static_cast<double>(usual_time_us(std::move(stamps_us), INT64_MIN));
  std::vector<event_t> out;
  for (std::size_t a = 0; a < channels_.size(); ++a) {
    if (auto event = of_rate(a, lost[a], time_us)) out.push_back(std::move(*event));
    if (auto event = of_clock(a, median_us, time_us)) out.push_back(std::move(*event));
    channels_[a].came = 0;
  }
  return out;
}

std::optional<event_t> StampEvents::of_rate(std::size_t axis, std::int64_t lost,
                                            std::int64_t time_us) {
  Channel& c = channels_[axis];
  const double span_s = seconds_between(c.first_us, c.newest_us);
  const bool broken = c.came == 0 || span_s < 0 || span_s > 3 * kSpan_s;
  if (!broken && span_s < kSpan_s) return std::nullopt;
  const auto samples = static_cast<double>(std::exchange(c.samples, 0) - 1);
  const auto newly_lost = static_cast<double>(lost - std::exchange(c.lost, lost));
  if (broken) return std::nullopt;
  const double expected = rate_hz_ * span_s, allowed = std::max(kFew, kMost_ratio * expected);
  const bool few = expected - samples - std::max(newly_lost, 0.0) > allowed;
  const bool many = samples - expected > allowed;
  c.spans = (few || many) != c.off_rate ? c.spans + 1 : 0;
  if (c.spans < kSpans) return std::nullopt;
  c.spans = 0;
  c.off_rate = few || many;
  if (c.off_rate) c.off_since_us = time_us - kSpans * kSpan_s * kSecond_us;
  event_t m = warning_event({"channel_rate", axes_[axis].name,
                             kFirstStampId + 2 * static_cast<std::int64_t>(axis), c.off_since_us},
                            raised_or_cleared(c.off_rate), time_us);
  m.value = samples / span_s;
  m.unit = "Hz";
  m.message = c.off_rate
                  ? fmt::format(
                        "{} sends {:.4g} samples a second{}, but rate_hz is {:g}. Set the node's "
                        "rate",
                        m.place, m.value, few ? " without a missing number" : "", rate_hz_)
                  : fmt::format("{} sends at its rate again", m.place);
  return m;
}

std::optional<event_t> StampEvents::of_clock(std::size_t axis, double median_us,
                                             std::int64_t time_us) {
  Channel& c = channels_[axis];
  if (c.came == 0) return std::nullopt;
  const double offset_s = 1e-6 * (static_cast<double>(c.newest_us) - median_us) - axes_[axis].delay;
  const double steps = offset_s * rate_hz_;
  const bool late = std::abs(offset_s) > lateness_s_;
  const bool at_rate = static_cast<double>(c.came) < (1 + kMoreOften) * rate_hz_;
  const bool apart = late || (at_rate && std::abs(steps - std::round(steps)) > kOffGrid);
  c.seconds = apart != c.apart ? c.seconds + 1 : 0;
  if (c.seconds < kApart_s) return std::nullopt;
  c.seconds = 0;
  c.apart = apart;
  if (apart) c.apart_since_us = time_us - kApart_s * kSecond_us;
  event_t m =
      warning_event({"channel_clock", axes_[axis].name,
                     kFirstStampId + 2 * static_cast<std::int64_t>(axis) + 1, c.apart_since_us},
                    raised_or_cleared(apart), time_us);
  m.value = offset_s;
  m.unit = "s";
  m.message = late ? fmt::format(
                         "the clock of {} is {} {} the others, so their samples do not come "
                         "together. Check the node's clock",
                         m.place, length(offset_s), offset_s > 0 ? "ahead of" : "behind")
              : apart
                  ? fmt::format(
                        "{} samples between the instants of the others, so its samples are left "
                        "out. Check the node's clock",
                        m.place)
                  : fmt::format("the clock of {} agrees with the others again", m.place);
  return m;
}

std::optional<event_t> ClockEvents::update(std::int64_t time_us, std::int64_t arrival_us) {
  const double passed_s = seconds_between(time_us_, time_us);
  const double waited_s = arrival_us == 0 || arrival_us_ == 0
                              ? std::max(passed_s, 0.0)
                              : seconds_between(arrival_us_, arrival_us);
  const double step_s = passed_s - waited_s;
  const std::int64_t before_us = std::exchange(time_us_, time_us);
  arrival_us_ = arrival_us;
  const bool usual = passed_s >= 0 && passed_s <= kLargest_s;
  const bool stepped = std::exchange(started_, true) && !usual && std::abs(step_s) > kLargest_s;
  const bool over = raised_ && std::abs(seconds_between(stepped_us_, time_us)) > kShown_s;
  if (!stepped && !over) return std::nullopt;
  const bool begins = !raised_;
  if (begins) since_us_ = time_us;
  off_s_ += stepped ? step_s : 0;
  raised_ = stepped && std::abs(off_s_) > kLargest_s;
  event_t m = warning_event({"clock_step", "all channels", kClockId, since_us_},
                            raised_ && !begins ? event_state::changed : raised_or_cleared(raised_),
                            time_us);
  m.value = off_s_;
  m.unit = "s";
  m.message = raised_ ? fmt::format(
                            "the sensors' clocks went {} by {}, from {} to {}. Check what sets "
                            "them",
                            step_s < 0 ? "back" : "ahead", length(step_s), utc_text(before_us),
                            utc_text(time_us))
              : stepped ? "the sensors' clocks are back where they were"
                        : "the sensors' clocks have not stepped for a day";
  stepped_us_ = time_us;
  if (!raised_) off_s_ = 0;
  return m;
}

}  // namespace framewatch::daemon
