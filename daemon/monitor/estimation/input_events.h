// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <framewatch/event_t.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/events/raised_events.h"
#include "drivers/can/can_map.h"
#include "drivers/can/can_status.h"
#include "drivers/lcm/accel_intake.h"
#include "estimator/motion/sample.h"
#include "estimator/motion/sample_merger.h"
#include "estimator/structure/sensors.h"

namespace framewatch::daemon {

/// Turns CAN notices into events: bus_off and interface_gone of buses, emergency, boot_up,
/// sequence_leap, duplicates and losses of nodes. Ids depend only on kind and place and are larger
/// than those of alarms.
class CanEvents {
 public:
  /// `map` must outlive this.
  explicit CanEvents(const drivers::CanMap& map);

  /// Returns nullopt if nothing changed: the state has already begun, or ends without a beginning.
  std::optional<event_t> of(const drivers::CanNotice& notice);

  template <typename Archive>
  void archive(Archive& a) {
    a(begun_);
  }

 private:
  struct Begun {
    std::int64_t since_us = 0;
    bool on = false;
    int code = 0;

    template <typename Archive>
    void archive(Archive& a) {
      a(since_us, on, code);
    }
  };

  const drivers::CanMap& map_;
  std::vector<Begun> begun_;  ///< by kind, then by bus or node
};

/// Reports dead and absurd channels with three kinds of events. A "channel_silent" has had no
/// sample for kSilent_s plus the wait for late samples, while others send; its next sample clears
/// the event. A "channel_stuck" has had most samples of kStuck_s left out because they did not
/// change while the building moved; changes for kMoving_s clear the event. A channel with
/// "absurd_samples" sends values that no sensor can have measured (AxisCounters::absurd). It clears
/// after kQuiet_s without one. Ids depend only on kind and channel and are larger than those of all
/// other events.
class ChannelEvents {
 public:
  static constexpr int kSilent_s = 5, kStuck_s = 2, kMoving_s = 3, kQuiet_s = 600;

  /// `axes` must outlive this; `lateness_s` is the estimator's option.
  ChannelEvents(const std::vector<estimator::SensorAxis>& axes, double lateness_s);

  /// Takes every sample.
  void sample(const estimator::AccelSample& sample);
  /// Returns the events raised or cleared since the last call. Call it once a second of sensor
  /// time; `counters` are by axis.
  std::vector<event_t> update(const std::vector<estimator::AxisCounters>& counters,
                              std::int64_t time_us);

  template <typename Archive>
  void archive(Archive& a) {
    a(absurd_, channels_);
  }

 private:
  struct Absurd {
    std::int64_t seen = 0, before = 0;  ///< absurd samples so far, and before the event was raised
    std::int64_t since_us = 0, newest_us = 0;
    bool raised = false;

    template <typename Archive>
    void archive(Archive& a) {
      for (std::int64_t* count : {&seen, &before}) a.within(*count, 0, a.kMaxCount);
      for (std::int64_t* us : {&since_us, &newest_us})
        a.within(*us, -2 * a.kMaxCount, 2 * a.kMaxCount);
      a(raised);
    }
  };
  /// The state of one kind of event of a channel.
  struct Trouble {
    int seconds = 0;  ///< consecutive seconds that speak for it; while it is raised, against it
    bool raised = false;
    std::int64_t since_us = 0;

    template <typename Archive>
    void archive(Archive& a) {
      a.within(seconds, 0, a.kMaxCount);
      a(raised);
      a.within(since_us, -2 * a.kMaxCount, 2 * a.kMaxCount);
    }
  };
  struct Channel {
    std::int64_t received = 0, stuck = 0;  ///< at the last update()
    std::int64_t heard_us = 0;             ///< last update() with new samples
    double value = 0;
    bool changed = false;  ///< its value changed since the last update()
    Trouble silent, still;

    template <typename Archive>
    void archive(Archive& a) {
      for (std::int64_t* count : {&received, &stuck}) a.within(*count, 0, a.kMaxCount);
      a.within(heard_us, -2 * a.kMaxCount, 2 * a.kMaxCount);
      a(value, changed, silent, still);
    }
  };
  /// Updates the state of an event. Returns true if it is raised or cleared now.
  static bool turns(Trouble& trouble, bool speaks_for, bool speaks_against, int raise_s,
                    int clear_s);
  static bool turns(Absurd& absurd, std::int64_t seen, std::int64_t time_us);
  event_t event_of(std::size_t axis, const Trouble& trouble, bool silent,
                   std::int64_t time_us) const;
  event_t absurd_event(std::size_t axis, std::int64_t time_us) const;

  const std::vector<estimator::SensorAxis>& axes_;
  int silent_s_;
  std::vector<Absurd> absurd_;
  std::vector<Channel> channels_;
};

/// Returns an event about a node's messages: two_senders, sequence_leap, duplicates, losses, or
/// channel_table for a table that contradicts the configuration. The place is a channel, for a node
/// its first one. Ids depend only on kind and place and are larger than those of alarms and CAN
/// events. Returns nullopt if the problem is over and its event is not among the `raised`.
std::optional<event_t> intake_event(const drivers::IntakeNotice& notice, const Config& config,
                                    const RaisedEvents& raised, std::int64_t now_us);

}  // namespace framewatch::daemon
