// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <framewatch/event_t.hpp>

#include "estimator/motion/sample.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/sensors.h"

namespace framewatch::daemon {

/// Reports channels whose stamps do not fit, with two kinds of events.
///
/// A "channel_rate" sends more or fewer samples than the configured rate in kSpans spans of
/// kSpan_s, measured by its stamps, and the numbers of its messages show no loss that explains it.
/// As many spans that fit clear the event.
///
/// A "channel_clock" has stamps that differ from the median channel's by more than the wait for
/// late samples, for kApart_s. As many seconds of agreement clear the event. Ids depend only on
/// kind and channel and are larger than those of all other events of channels.
class StampEvents {
 public:
  static constexpr int kSpan_s = 5, kSpans = 2, kApart_s = 3;

  /// `axes` must outlive this.
  StampEvents(const std::vector<estimator::SensorAxis>& axes,
              const estimator::EstimatorOptions& options);

  /// Takes every sample.
  void sample(const estimator::AccelSample& sample);
  /// Returns the events raised or cleared since the last call. Call it once a second of sensor
  /// time. `lost` counts the lost messages of every axis.
  std::vector<event_t> update(const std::vector<std::int64_t>& lost, std::int64_t time_us);

  template <typename Archive>
  void archive(Archive& a) {
    a(channels_);
  }

 private:
  struct Channel {
    std::int64_t first_us = 0, newest_us = 0;  ///< its stamps: first one of the span, newest one
    std::int64_t samples = 0;                  ///< of the span
    std::int64_t came = 0;                     ///< samples since the last update()
    std::int64_t lost = 0;                     ///< messages lost before the span
    int spans = 0;    ///< consecutive ones that speak for another state of its rate
    int seconds = 0;  ///< consecutive ones that speak for another state of its clock
    bool off_rate = false, apart = false;  ///< raised events
    std::int64_t off_since_us = 0, apart_since_us = 0;

    template <typename Archive>
    void archive(Archive& a) {
      a(first_us, newest_us, off_since_us, apart_since_us);
      for (std::int64_t* count : {&samples, &came}) a.within(*count, 0, a.kMaxCount);
      a.within(lost, -a.kMaxCount, a.kMaxCount);
      for (int* turns : {&spans, &seconds}) a.within(*turns, 0, a.kMaxCount);
      a(off_rate, apart);
    }
  };
  std::optional<event_t> of_rate(std::size_t axis, std::int64_t lost, std::int64_t time_us);
  std::optional<event_t> of_clock(std::size_t axis, double median_us, std::int64_t time_us);

  const std::vector<estimator::SensorAxis>& axes_;
  double rate_hz_, lateness_s_;
  std::vector<Channel> channels_;
};

/// Reports steps of all sensor clocks together with the kind "clock_step": the sensors' time goes
/// back, or ahead of the time that passes at the receiver, by more than kLargest_s. The event is
/// cleared when the clocks step back to where they were, or kShown_s after the last step.
class ClockEvents {
 public:
  static constexpr double kLargest_s = 10, kShown_s = 86'400;

  /// Takes the sensors' time, once a second of it. `arrival_us`: receiver's clock, 0 if unknown;
  /// only a step back is seen then. Returns an event that is raised, changed or cleared.
  std::optional<event_t> update(std::int64_t time_us, std::int64_t arrival_us);

  template <typename Archive>
  void archive(Archive& a) {
    a(started_, raised_, time_us_, arrival_us_, since_us_, stepped_us_);
    a.finite(off_s_);
  }

 private:
  bool started_ = false, raised_ = false;
  std::int64_t time_us_ = 0, arrival_us_ = 0;   ///< of the last update()
  std::int64_t since_us_ = 0, stepped_us_ = 0;  ///< times after the first and the newest step
  double off_s_ = 0;                            ///< sum of the steps
};

}  // namespace framewatch::daemon
