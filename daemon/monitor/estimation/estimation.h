// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/config/config.h"
#include "daemon/monitor/estimation/input_events.h"
#include "daemon/monitor/estimation/publisher.h"
#include "daemon/monitor/estimation/stamp_events.h"
#include "daemon/monitor/estimation/weather_intake.h"
#include "daemon/monitor/event_report/event_report.h"
#include "daemon/monitor/events/raised_events.h"
#include "drivers/can/can_intake.h"
#include "drivers/lcm/accel_intake.h"
#include "estimator/gap/gap_monitor.h"
#include "estimator/identify/estimate/estimate.h"
#include "estimator/motion/sample.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/shaking/shaking_watch.h"
#include "estimator/watch/recovery_watch.h"

namespace framewatch::daemon {

/// Tells when a second of sensor time has passed. A jump of a single node's clock does not move it;
/// kStraysToFollow samples in a row do.
class SensorSeconds {
 public:
  /// Returns true for the first sample and for the first sample of each further second.
  bool passed(std::int64_t time_us);
  std::int64_t newest_us() const { return newest_us_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(started_);
    for (std::int64_t* us : {&newest_us_, &next_us_})
      a.within(*us, -2 * a.kMaxCount, 2 * a.kMaxCount + kSecond_us);
    a.within(strays_, 0, kStraysToFollow);
  }

 private:
  static constexpr std::int64_t kLargestStep_us = 10 * kSecond_us;
  static constexpr int kStraysToFollow = 1000;  ///< in a row

  bool started_ = false;
  std::int64_t newest_us_ = 0;
  std::int64_t next_us_ = 0;
  int strays_ = 0;
};

/// Returns the configured axes in the form that the drivers need.
std::vector<drivers::WantedAxis> wanted_axes(const Config& config);
drivers::IntakeSettings intake_settings(const Config& config);

/// Returns the configuration with PipelineConfig::design_error, change_error and change_leak,
/// predicted for the usual shaking from the tolerances of masses and stories. Returns it unchanged
/// if every story is identified. Takes up to seconds for a tall building that bends.
estimator::PipelineConfig with_design_error(estimator::PipelineConfig config);

/// Receives the input and the findings of an Estimation, in addition to the messages that it
/// publishes. Override the methods you need; arguments are valid during the call.
class EstimationListener {
 public:
  virtual ~EstimationListener() = default;

  /// A sample, before the pipeline takes it.
  virtual void on_sample(const estimator::AccelSample& /*sample*/) {}
  /// A message about weather that could be read: temperature_t or weather_t, which records keep. A
  /// CAN signal comes as weather_t.
  virtual void on_weather(const std::string& /*channel*/, std::int64_t /*time_us*/,
                          const std::vector<std::uint8_t>& /*bytes*/) {}
  /// A calibrated instant.
  virtual void on_instant(const estimator::SampleSet& /*instant*/) {}
  /// An estimate of the main window, before it is published.
  virtual void on_estimate(const estimator::WindowEstimate& /*estimate*/) {}
  virtual void on_gap(const estimator::GapNews& /*news*/) {}
  /// An event, after it was published.
  virtual void on_event(const event_t& /*event*/) {}
  /// The report of a strong motion that has ended.
  virtual void on_shaken(const EventReport& /*report*/) {}
};

/// A part of an estimation's state that can be read independently (docs/formats.md).
struct StateSection {
  std::string name;
  std::vector<std::uint8_t> bytes;
  int format = estimator::kStateFormat;
};

/// Turns input messages into output messages: intakes (LCM, CAN), pipeline, change detection, gap
/// monitor, events and publisher. Live and replayed samples take the same path. Uses no clock.
class Estimation {
 public:
  /// `config` and `listener` must outlive this. `sink` publishes messages; if it is empty, no
  /// message is made.
  Estimation(const Config& config, MessageSink sink, EstimationListener* listener = nullptr);

  /// See Pipeline. Call it before the first sample.
  void start_tuned(const estimator::Tuning& tuning) { pipeline_.start_tuned(tuning); }

  /// Takes any LCM message. `received_us`: see AccelIntake::message().
  drivers::IntakeResult message(const std::string& channel, const void* data, std::size_t size,
                                const drivers::LcmSender& sender = {},
                                std::int64_t received_us = 0);
  /// Tells that the messages of another log follow.
  void log_begins() { intake_.log_begins(); }
  /// Takes one CAN frame of the bus with this index in the configuration.
  void frame(int bus, const drivers::CanFrame& frame);
  /// Takes a state of a CAN bus that no frame reports.
  void notice(const drivers::CanNotice& notice);
  /// Takes a value of weather that no message names, in raw units. `covariate`: index in the
  /// configuration. time_us: sensor time; absent: that of the newest sample. Ignored before the
  /// first sample.
  void weather_value(std::size_t covariate, double value,
                     std::optional<std::int64_t> time_us = std::nullopt);
  /// Takes one value from a file that has channel names instead of messages.
  void sample(const estimator::AccelSample& sample);
  /// Ends the input: closes open instants and publishes the last table and status.
  void finish();

  /// Sets the counters that go out with the next status.
  void set_live(const LiveState& live) { live_ = live; }
  const drivers::AccelIntake& intake() const { return intake_; }
  const drivers::CanIntake& can() const { return can_; }
  const estimator::Pipeline& pipeline() const { return pipeline_; }
  /// Returns the counters of every axis, of the intakes and the pipeline together.
  std::vector<estimator::AxisCounters> axis_counters() const;
  std::int64_t windows() const { return windows_; }  ///< published so far
  const RaisedEvents& raised() const { return raised_; }
  RaisedEvents& raised() { return raised_; }
  /// Makes the gap monitor simulate this model from now on. Does nothing without [gap].
  void adopt(const estimator::GapModel& model) {
    if (gap_) gap_->adopt(model);
  }
  /// Returns the baseline of the change detection; nullptr while it is learned and without [watch].
  const estimator::Baseline* baseline() const { return watch_ ? watch_->baseline() : nullptr; }

  /// Takes over the state of `before`, which has the same structure, channels and grid but other
  /// settings. Call it before the first sample. With `keep_window` the samples in the window are
  /// kept, because the new settings weight them alike. Parts whose state does not fit the new
  /// settings start again: a gap window of another length, changes against another baseline.
  void take_over(Estimation& before, bool keep_window);

  /// Returns the whole state, section by section.
  std::vector<StateSection> save();
  /// Returns the names of the sections that save() gives.
  std::vector<std::string> section_names();
  /// Loads these sections before the first sample. "watch" needs "baseline". Returns an empty
  /// string, or the name of the section that does not fit; this object must not be used then. After
  /// loading all sections of an estimation of the same configuration it continues as that one
  /// would, bit by bit.
  [[nodiscard]] std::string load(const std::vector<StateSection>& sections);
  /// Tells, after load(), which sections were missing. Events that only they could clear are
  /// withdrawn with the next status.
  void went_without(const std::vector<std::string>& lost);
  /// Returns the sensor time of the newest sample of every axis; INT64_MIN if an axis has had no
  /// sample.
  const std::vector<std::int64_t>& newest_us() const { return newest_us_; }
  /// Tells that this process starts with the samples up to newest_us(), from a state or a history,
  /// and receives samples from now on. A report of strong motion then names the time between.
  /// `raw`: it has read the last raw samples that the process before stored.
  void came_up(bool raw);

 private:
  template <typename Visit>
  void each_section(const Visit& visit);
  void publish_state();
  drivers::IntakeResult temperature(const std::string& channel,
                                    std::span<const std::uint8_t> bytes);
  drivers::IntakeResult weather(const std::string& channel, std::span<const std::uint8_t> bytes);
  void take(estimator::Pipeline::Results&& results);
  bool speaks_of_building() const;
  void watch(const estimator::WindowEstimate& estimate);
  void follow_recovery(const estimator::WindowEstimate& estimate);
  /// Returns true if the change of this parameter began with the strong motion of its recovery law.
  bool is_recovering(const event_t& event, int parameter) const;
  event_t with_recovery(event_t event, int parameter) const;
  void compare_gap(const estimator::SampleSet& instant);
  void follow_shaking(const estimator::SampleSet& instant);
  void add_records(EventReport& report) const;
  void begin_watch();
  void begin_gap();
  void intake_notice(const drivers::IntakeNotice& notice);
  void announce(const event_t& event);
  /// Clears the raised events of a kind that is not monitored any more.
  void withdraw(const std::string& kind);

  const Config& config_;
  EstimationListener* listener_;  ///< never null
  Publisher publisher_;
  RaisedEvents raised_;
  const estimator::PipelineConfig foreseen_;  ///< with the predicted errors of the layout
  estimator::Pipeline pipeline_;
  std::optional<estimator::Watch> watch_;
  estimator::StrongMotion strong_;
  std::optional<estimator::RecoveryWatch> recovery_;  ///< only with watch_
  std::optional<estimator::GapMonitor> gap_;
  std::optional<estimator::ShakingWatch> shaking_;
  std::vector<estimator::AxisCounters> counted_before_;  ///< at the start of the strong motion
  std::vector<event_t> findings_;                        ///< since the start of the strong motion
  std::optional<estimator::Tuning> tuning_;              ///< of the state loaded or saved last
  std::vector<event_t> to_withdraw_;   ///< set by went_without(), until the next status
  std::vector<double> noise_density_;  ///< of the last second
  drivers::AccelIntake intake_;
  drivers::CanIntake can_;
  CanEvents can_events_;
  ChannelEvents channel_events_;
  StampEvents stamp_events_;
  ClockEvents clock_events_;
  std::int64_t arrival_us_ = 0;  ///< receiver's clock, of the message that is taken; 0: unknown
  SensorSeconds seconds_;
  std::vector<std::int64_t> newest_us_;
  LiveState live_;
  std::int64_t windows_ = 0;
  std::int64_t absurd_temperatures_ = 0;
  WeatherIntake weather_;
};

}  // namespace framewatch::daemon
