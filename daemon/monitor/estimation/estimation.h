#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/temperature_t.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/estimation/absurd_events.h"
#include "daemon/monitor/estimation/can_events.h"
#include "daemon/monitor/estimation/channel_events.h"
#include "daemon/monitor/estimation/estimation_listener.h"
#include "daemon/monitor/estimation/publisher.h"
#include "daemon/monitor/estimation/sensor_seconds.h"
#include "daemon/monitor/estimation/state_section.h"
#include "daemon/monitor/estimation/wanted_axes.h"
#include "daemon/monitor/events/raised_events.h"
#include "drivers/can/can_intake.h"
#include "drivers/lcm/accel_intake.h"
#include "estimator/gap/gap_monitor.h"
#include "estimator/shaking/shaking_watch.h"
#include "estimator/watch/recovery_watch.h"
#include "estimator/watch/strong_motion.h"

namespace framewatch::daemon {

/// Messages in, messages out: intakes (LCM, CAN), pipeline, change detection, gap monitor, events
/// and publisher. Live and replayed samples take the same path. Uses no clock.
class Estimation {
 public:
  /// `config` and `listener` must outlive this. sink: publishes messages; empty: they are not made.
  Estimation(const Config& config, MessageSink sink, EstimationListener* listener = nullptr);

  /// See Pipeline; to be called before the first sample.
  void start_tuned(const estimator::Tuning& tuning) { pipeline_.start_tuned(tuning); }

  /// One LCM message, whatever it is. received_us: see AccelIntake::message().
  drivers::IntakeResult message(const std::string& channel, const void* data, std::size_t size,
                                const drivers::LcmSender& sender = {},
                                std::int64_t received_us = 0);
  /// The messages of another log follow.
  void log_begins() { intake_.log_begins(); }
  /// One CAN frame of the bus with this index in the configuration.
  void frame(int bus, const drivers::CanFrame& frame) { can_.frame(bus, frame); }
  /// A state of a CAN bus that no frame reports.
  void notice(const drivers::CanNotice& notice);
  /// One value from a file that has names instead of messages.
  void sample(const estimator::AccelSample& sample);
  /// The input has ended: closes open instants, publishes the last table and status.
  void finish();

  /// Goes out with the next status.
  void set_live(const LiveState& live) { live_ = live; }
  const drivers::AccelIntake& intake() const { return intake_; }
  const drivers::CanIntake& can() const { return can_; }
  const estimator::Pipeline& pipeline() const { return pipeline_; }
  /// What happened to the samples of every axis, before and in the pipeline.
  std::vector<estimator::AxisCounters> axis_counters() const;
  std::int64_t windows() const { return windows_; }  ///< published
  /// Events that are raised and not cleared.
  const RaisedEvents& raised() const { return raised_; }
  RaisedEvents& raised() { return raised_; }
  /// The gap monitor simulates this model from now on; without [gap] nothing happens.
  void adopt(const estimator::GapModel& model);
  /// The baseline of the change detection; null while it is learned, and without [watch].
  const estimator::Baseline* baseline() const { return watch_ ? watch_->baseline() : nullptr; }

  /// Takes the state over from `before`, which has the same structure, channels and grid but other
  /// settings. To be called before the first sample. keep_window: the samples in the window are
  /// kept, because the new settings weight them alike. Parts whose state does not fit the new
  /// settings start anew: a gap window of another length, changes against another baseline.
  void take_over(Estimation& before, bool keep_window);

  /// The whole state, section by section.
  std::vector<StateSection> save();
  /// Names of the sections that save() gives.
  std::vector<std::string> section_names();
  /// Takes over the sections it is given, before the first sample. Empty on success; else the name
  /// of the section that does not fit, and this must not be used any more. With all sections of an
  /// estimation of the same configuration it continues as that one would, to the bit. "watch" needs
  /// "baseline".
  [[nodiscard]] std::string load(const std::vector<StateSection>& sections);
  /// After load(): these sections were not among those it was given. Findings that they alone could
  /// clear are withdrawn with the next status.
  void went_without(const std::vector<std::string>& lost);
  /// Sensor time of the newest sample of every axis that was taken; INT64_MIN: none was.
  const std::vector<std::int64_t>& newest_us() const { return newest_us_; }
  /// The process began with the samples up to newest_us(), by a state or from a history, and
  /// listens from now on: a report of strong motion says what lies between. raw: it read the raw
  /// samples that the process before had stored last.
  void came_up(bool raw);

 private:
  template <typename Visit>
  void each_section(const Visit& visit);
  void publish_state();
  drivers::IntakeResult temperature(const void* data, std::size_t size);
  void take(estimator::Pipeline::Results&& results);
  void main_window(const estimator::WindowEstimate& estimate);
  void late_window(const estimator::WindowEstimate& estimate);
  void watch(const estimator::WindowEstimate& estimate);
  void follow_recovery(const estimator::WindowEstimate& estimate);
  /// Whether a change of this parameter began with the strong motion that its recovery law is of.
  bool is_recovering(const event_t& event, int parameter) const;
  event_t with_recovery(event_t event, int parameter) const;
  void look_for_gap(const estimator::SampleSet& instant);
  void look_for_shaking(const estimator::SampleSet& instant);
  void begin_shaking();
  void add_records(EventReport& report) const;
  void begin_watch();
  void begin_gap();
  void intake_notice(const drivers::IntakeNotice& notice);
  void announce(const event_t& event);
  /// Clears the raised events of a kind that is not looked for any more.
  void withdraw(const std::string& kind);

  const Config& config_;
  EstimationListener* listener_;  ///< never null
  Publisher publisher_;
  RaisedEvents raised_;
  const estimator::PipelineConfig foreseen_;  ///< with what the layout makes of errors
  estimator::Pipeline pipeline_;
  std::optional<estimator::Watch> watch_;
  estimator::StrongMotion strong_;
  std::optional<estimator::RecoveryWatch> recovery_;  ///< with watch_
  std::optional<estimator::GapMonitor> gap_;
  std::optional<estimator::ShakingWatch> shaking_;
  std::vector<estimator::AxisCounters> counted_before_;  ///< when the strong motion began
  std::vector<event_t> findings_;                        ///< since then
  std::optional<estimator::Tuning> tuning_;  ///< of the state that was loaded or saved last
  std::vector<event_t> to_withdraw_;         ///< went_without(), until the next status
  std::vector<double> noise_density_;        ///< as of the last second
  drivers::AccelIntake intake_;
  drivers::CanIntake can_;
  CanEvents can_events_;
  AbsurdEvents absurd_events_;
  ChannelEvents channel_events_;
  SensorSeconds seconds_;
  std::vector<std::int64_t> newest_us_;
  LiveState live_;
  std::int64_t windows_ = 0;
  std::int64_t absurd_temperatures_ = 0;
};

}  // namespace framewatch::daemon
