#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include <framewatch/temperature_t.hpp>

#include "daemon/can_events.h"
#include "daemon/clocks.h"
#include "daemon/config.h"
#include "daemon/publisher.h"
#include "drivers/accel_intake.h"
#include "drivers/can/can_intake.h"
#include "estimator/watch/gap_monitor.h"

namespace framewatch::daemon {

/// Decides when a second of sensor time has passed. A node whose clock is elsewhere does not move
/// it unless everybody's clock is there.
class SensorSeconds {
 public:
  /// Whether the first sample or a new second has come.
  bool passed(std::int64_t time_us);
  std::int64_t newest_us() const { return newest_us_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(started_, newest_us_, next_us_, strays_);
  }

 private:
  static constexpr std::int64_t kLargestStep_us = 10 * kSecond_us;
  static constexpr int kStraysToFollow = 1000;  ///< in a row

  bool started_ = false;
  std::int64_t newest_us_ = 0;
  std::int64_t next_us_ = 0;
  int strays_ = 0;
};

/// Messages in, messages out: intake, pipeline and publisher. The one path of live and replayed
/// samples; asks no clock.
class Estimation {
 public:
  using Observer = std::function<void(const WindowEstimate&)>;

  /// `config` must outlive this. `observer`, if any, sees every estimate before it is published.
  Estimation(const Config& config, MessageSink sink, Observer observer = {});

  /// One LCM message, whatever it is.
  drivers::IntakeResult message(const std::string& channel, const void* data, std::size_t size);
  /// One CAN frame of the bus with this index in the configuration.
  void frame(int bus, const drivers::CanFrame& frame) { can_.frame(bus, frame); }
  /// Something about CAN that is in no frame.
  void notice(const drivers::CanNotice& notice);
  /// One value from a file that has names instead of messages.
  void sample(const AccelSample& sample);
  /// The input has ended: closes open instants, publishes the last table and status.
  void finish();

  /// Who else sees what comes in, and news of gaps; any may be empty.
  struct Taps {
    std::function<void(const AccelSample&)> sample;
    std::function<void(const temperature_t&)> temperature;
    std::function<void(const GapNews&)> gap;
  };
  void tap(Taps taps) { taps_ = std::move(taps); }

  /// Goes out with the next status.
  void set_live(const LiveState& live) { live_ = live; }
  const drivers::AccelIntake& intake() const { return intake_; }
  const drivers::CanIntake& can() const { return can_; }
  const Pipeline& pipeline() const { return pipeline_; }
  std::int64_t windows() const { return windows_; }  ///< published
  /// Events that are raised and not cleared.
  const RaisedEvents& raised() const { return publisher_.raised(); }
  RaisedEvents& raised() { return publisher_.raised(); }
  /// From now on the gap monitor simulates this; nothing without [gap].
  void adopt(const GapModel& model);
  /// What changes are judged against; null while it is learned, or when nothing is watched.
  const Baseline* baseline() const { return watch_ ? watch_->baseline() : nullptr; }

  /// Goes on where `before` is, which has the same structure, channels and grid and other settings.
  /// keep_window: its rows are weighted alike. Not called after the first sample. What other
  /// settings do not fit begins anew: the gap's window of another length, a change watched against
  /// another baseline.
  void take_over(Estimation& before, bool keep_window);

  /// Everything that what is still to come depends on, and back; see Pipeline.
  void save(StateWriter& state);
  [[nodiscard]] bool load(StateReader& state);

 private:
  void publish_state();
  drivers::IntakeResult temperature(const void* data, std::size_t size);
  void main_window(const WindowEstimate& estimate);
  void watch(const WindowEstimate& estimate);
  void look_for_gap(const SampleSet& instant);
  void begin_watch();
  void begin_gap();

  const Config& config_;
  Observer observer_;
  Taps taps_;
  Publisher publisher_;
  Pipeline pipeline_;
  std::optional<Watch> watch_;
  std::optional<GapMonitor> gap_;
  std::vector<double> noise_density_;  ///< as of the last second
  drivers::AccelIntake intake_;
  drivers::CanIntake can_;
  CanEvents can_events_;
  SensorSeconds seconds_;
  LiveState live_;
  std::int64_t windows_ = 0;
};

/// The configured axes as the drivers know them.
std::vector<drivers::WantedAxis> wanted_axes(const Config& config);

}  // namespace framewatch::daemon
