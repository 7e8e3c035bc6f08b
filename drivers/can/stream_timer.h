#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "drivers/can/archive_containers.h"
#include "drivers/can/arrival_numbering.h"
#include "drivers/can/can_map.h"
#include "drivers/can/host_clock_steps.h"
#include "drivers/can/lower_envelope_clock.h"
#include "drivers/can/slew_limiter.h"

namespace framewatch::drivers {

/// Values of one CAN frame that wait for their time.
struct TimedValues {
  int node = 0, message = 0;  ///< CAN node and message of the map
  std::int64_t number = 0;    ///< of the frame in its stream; set by StreamTimer
  std::vector<double> values;

  template <typename Archive>
  void archive(Archive& a) {
    a(node, message, number);
    a.any_size(values);
  }
};

/// Gives the frames of one free-running stream (a CAN node, or the SYNC of a bus) their number and
/// time, from a counter, a clock or their arrival. The clock model (LowerEnvelopeClock) maps the
/// node's time to the host's. Pure: asks no clock.
///
/// A frame fits when a busy bus explains how much later than the clock model its stamp is. Frames
/// that do not fit are held until it is clear whether the node restarted, the host's clock stepped
/// or the frames are late:
///
///      +----------+   enough frames for a clock model    +---------+
///   -> | STARTING | -----------------------------------> | RUNNING | <--+
///      +----------+                                      +---------+    |
///           ^                              does not fit   |       ^     |
///           |                                             v       | fits, or the host's clock
///           |       5 agree: the node restarted          +---------+    | stepped
///           +------------------------------------------- | HOLDING |    |
///                                                        +---------+    |
///                  5 agree and continue the numbers:      |       ^     | fits
///                  they are late                          v       | does not continue the
///                                                        +---------+    | numbers, or too many
///                                                        |  LATE   | ---+
///                                                        +---------+
///
/// STARTING  Frames are held; 0.2 s of them, 3 to 20, make a clock model, and are delivered.
/// RUNNING   A frame that fits is delivered and updates the clock model.
/// HOLDING   Frames are held. When one fits, or its lateness differs from that of the held ones,
///           those are delivered as late. The host's clock has stepped when other streams see it
///           too.
/// LATE      Frames that do not fit are delivered as they come, `patience_us` of them at most.
///
/// In every state restart() leads to STARTING; a step of the host's clock that other streams found
/// leads to RUNNING, or to STARTING where arrival alone gives the time; confirm() with another
/// number of a held frame leads to LATE. Frames that arrival alone numbers (CanTiming::period) and
/// that follow a pause wait in ArrivalNumbering before they enter the diagram.
class StreamTimer final : public StampedStream {
 public:
  struct Settings {
    CanTiming kind = CanTiming::period;  ///< not sync
    double period_us = 10000;            ///< between frames
    double tick_us = 10000;              ///< device microseconds per unit of `reading`
    double modulus = 0;                  ///< units after which the reading wraps; 0: never
    double patience_us = 1e6;  ///< how long late frames may continue before they are a restart
  };
  using Deliver = std::function<void(const TimedValues&, double time_us)>;

  StreamTimer(const Settings& settings, HostClockSteps& steps);
  StreamTimer(const StreamTimer&) = delete;
  StreamTimer& operator=(const StreamTimer&) = delete;

  /// To be set before the first frame.
  void on_delivery(Deliver deliver) { deliver_ = std::move(deliver); }

  /// A frame that opens a sample. `reading`: counter or clock, in its units; unused for period.
  void open_sample(double reading, double host_us, TimedValues values);
  /// Number of the sample opened last, as far as is known.
  std::int64_t opened_number() const { return opened_.values.number; }
  /// The number of the sample opened last, from another source. False when it cannot be that one. A
  /// frame that was held because of its stamp is no longer in doubt: it is late, or its counter
  /// began anew.
  bool confirm(std::int64_t number);
  /// More values of the sample opened last.
  void attach(TimedValues values);
  /// More values of the sample `values.number`, opened before. False: its time is not known.
  bool attach_earlier(TimedValues values);
  /// The node said that it starts anew (CANopen boot-up).
  void restart();
  /// Delivers what is still held.
  void finish();

  double period_us() const { return settings_.period_us * clock_.rate(); }
  std::int64_t restarts() const { return restarts_; }
  std::int64_t unplaced() const { return unplaced_; }  ///< frames without a plausible time

  template <typename Archive>
  void archive(Archive& a) {
    archive_vector(a, held_);
    archive_vector(a, unnumbered_);
    a(clock_, arrivals_, opened_, starting_, has_last_, renumber_, last_device_us_, last_host_us_);
    a(last_number_, opened_is_held_, clock_frames_, slew_, newest_number_, late_);
    a(late_frames_left_, restarts_, unplaced_, origin_us_);
  }

 private:
  struct Frame {
    double device_us = 0, host_us = 0;
    bool opens = false;  ///< a sample; else it was attached to one
    TimedValues values;

    template <typename Archive>
    void archive(Archive& a) {
      a(device_us, host_us, opens, values);
    }
  };

  // stream_timer.cpp: one frame after the other
  double device_time_us(double reading, double host_us) const;
  void open_by_arrival(double host_us, TimedValues values);
  void number_by_arrival();
  double time_of(double device_us);
  double late_us(const Frame& frame) const {
    return frame.host_us - clock_.host_us(frame.device_us);
  }
  bool fits(double late_us) const;
  double most_late_us() const;
  bool continues(const Frame& frame) const;
  std::size_t samples_held() const;
  void set_last(const Frame& frame);
  void deliver(const Frame& frame);
  void accept(Frame frame);
  void hold(Frame frame);
  void go_on_late();
  void deliver_held();
  bool shift_numbers(std::int64_t shift);
  bool undo_wraps(std::int64_t shift);

  // stream_timer_start.cpp: STARTING, and what leads to it
  void hold_until_started(Frame frame);
  void start_anew();
  void number_first_frames();
  void finish_start();
  Vote vote(double step_us, double now_us) const override;
  void shift(double step_us) override;

  Settings settings_;
  HostClockSteps& steps_;
  Deliver deliver_;
  LowerEnvelopeClock clock_;
  SlewLimiter slew_;
  std::vector<Frame> held_;
  bool starting_ = true;
  bool has_last_ = false;  ///< the last_ are of this start
  bool renumber_ = false;  ///< numbers of this start follow newest_number_
  double last_device_us_ = 0, last_host_us_ = 0;
  std::int64_t last_number_ = 0;
  Frame opened_{};  ///< by open_sample(), without its values
  bool opened_is_held_ = false;
  ArrivalNumbering arrivals_;
  std::vector<Frame> unnumbered_;    ///< those of arrivals_, and what was attached to them
  std::int64_t clock_frames_ = 0;    ///< that fitted the clock model
  std::int64_t newest_number_ = -1;  ///< largest that was delivered
  bool late_ = false;                ///< in LATE, or HOLDING after it
  int late_frames_left_ = 0;         ///< that LATE may still deliver
  double origin_us_ = 0;             ///< device time of the reading 0
  std::int64_t restarts_ = 0, unplaced_ = 0;
};

}  // namespace framewatch::drivers
