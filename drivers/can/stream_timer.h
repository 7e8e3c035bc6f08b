// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "drivers/can/archive_containers.h"
#include "drivers/can/arrival_numbering.h"
#include "drivers/can/can_map.h"
#include "drivers/can/lower_envelope_clock.h"

namespace framewatch::drivers {

/// A stream of frames with receive stamps of the host, which HostClockSteps asks about steps.
class StampedStream {
 public:
  enum class Vote {
    abstains,  ///< silent now, or without a clock or counter
    no,
    yes,
  };
  /// Says whether the stamp of the newest frame is off by this step (microseconds).
  virtual Vote vote(double step_us, double now_us) const = 0;
  /// Tells the stream that the host's clock has stepped: stamps from now on exclude the step.
  virtual void shift(double step_us) = 0;

 protected:
  ~StampedStream() = default;
};

/// Finds the steps of the host's clock and removes them from stamps. A step moves the stamps of
/// every stream, the restart of a node only its own. The number of streams that see the same step
/// at the same time decides between them.
class HostClockSteps {
 public:
  /// Adds a stream, which must outlive this object.
  void join(StampedStream& stream) { streams_.push_back(&stream); }
  /// Returns a stamp without the steps so far.
  double continuous(double stamp_us) const { return stamp_us - total_us_; }
  std::int64_t count() const { return count_; }
  /// A stream calls this when its stamps have stepped by `step_us`. Returns true and shifts every
  /// stream when at least two streams, and half of the active ones, agree. Returns false when the
  /// node has restarted.
  bool resolve(double step_us, double now_us);

  template <typename Archive>
  void archive(Archive& a) {
    a(total_us_, count_);
  }

 private:
  std::vector<StampedStream*> streams_;
  double total_us_ = 0;
  std::int64_t count_ = 0;
};

/// The values of one CAN frame, waiting for their time.
struct TimedValues {
  int node = 0, message = 0;  ///< indexes of CAN node and message in the map
  std::int64_t number = 0;    ///< number of the frame in its stream; set by StreamTimer
  std::vector<double> values;

  template <typename Archive>
  void archive(Archive& a) {
    a(node, message, number);
    a.any_size(values);
  }
};

/// Finds number and time of each frame of a free-running stream (a CAN node, or the SYNC of a bus)
/// from a counter, a clock or its arrival. The clock model (LowerEnvelopeClock) maps the time of
/// the node to that of the host. Pure: reads no clock.
///
/// A frame fits when a busy bus explains how late its stamp is compared with the clock model.
/// Frames that do not fit are held until it is clear whether the node restarted, the host's clock
/// stepped or the frames are late:
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
///           the held ones are delivered as late. The host's clock has stepped when other streams
///           see the step too.
/// LATE      Frames that do not fit are delivered as they come, `patience_us` of them at most.
///
/// In every state, restart() leads to STARTING. A step of the host's clock that other streams found
/// leads to RUNNING, or to STARTING when arrival alone gives the time. confirm() with another
/// number of a held frame leads to LATE. Frames that are numbered by arrival alone
/// (CanTiming::period) and follow a pause wait in ArrivalNumbering before they enter the diagram.
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

  /// Sets the receiver of timed values. Call it before the first frame.
  void on_delivery(Deliver deliver) { deliver_ = std::move(deliver); }

  /// Takes a frame that opens a sample. `reading` is its counter or clock in units of that; unused
  /// for CanTiming::period. `host_us` is its receive stamp.
  void open_sample(double reading, double host_us, TimedValues values);
  /// Returns the number of the sample opened last, as far as it is known.
  std::int64_t opened_number() const { return opened_.values.number; }
  /// Sets the number of the sample opened last from another source. Returns false when it cannot be
  /// that one. A frame that was held because of its stamp is then resolved: it is late, or its
  /// counter restarted.
  bool confirm(std::int64_t number);
  /// Adds values to the sample opened last.
  void attach(TimedValues values);
  /// Adds values to the earlier sample `values.number`. Returns false when its time is unknown.
  bool attach_earlier(TimedValues values);
  /// Begins a new start because the node announced it (CANopen boot-up).
  void restart();
  /// Delivers the frames that are still held.
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
    bool opens = false;  ///< opens a sample; else attached to one
    TimedValues values;

    template <typename Archive>
    void archive(Archive& a) {
      a(device_us, host_us, opens, values);
    }
  };

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

  // STARTING, and the transitions to it
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
  bool has_last_ = false;  ///< the last_ values belong to this start
  bool renumber_ = false;  ///< numbers of this start follow newest_number_
  double last_device_us_ = 0, last_host_us_ = 0;
  std::int64_t last_number_ = 0;
  Frame opened_{};  ///< sample opened last, without its values
  bool opened_is_held_ = false;
  ArrivalNumbering arrivals_;
  std::vector<Frame> unnumbered_;    ///< frames in arrivals_ and values attached to them
  std::int64_t clock_frames_ = 0;    ///< frames that fitted the clock model
  std::int64_t newest_number_ = -1;  ///< largest number delivered
  bool late_ = false;                ///< in LATE, or in HOLDING after it
  int late_frames_left_ = 0;         ///< frames that LATE may still deliver
  double origin_us_ = 0;             ///< device time of the reading 0
  std::int64_t restarts_ = 0, unplaced_ = 0;
};

}  // namespace framewatch::drivers
