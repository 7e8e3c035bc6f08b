#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "drivers/can/arrival_numbers.h"
#include "drivers/can/can_map.h"
#include "drivers/can/clock_line.h"

namespace framewatch::drivers {

/// Values of one frame that wait for their time.
struct TimedValues {
  int node = 0, message = 0;  ///< of the map
  std::int64_t number = 0;    ///< of the frame in its stream; set by StreamTimer
  std::vector<double> values;

  template <typename Archive>
  void archive(Archive& a) {
    a(node, message, number, values);
  }
};

class StreamTimer;

/// Steps of the host's clock are everybody's: told from a node's restart by how many streams see
/// the same step at the same time.
class HostSteps {
 public:
  void join(StreamTimer& timer) { timers_.push_back(&timer); }
  /// Stamp without the steps so far.
  double continuous(double stamp_us) const { return stamp_us - total_us_; }
  std::int64_t count() const { return count_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(total_us_, count_);
  }

 private:
  friend class StreamTimer;
  /// Called by a stream that is sure that something stepped. False: it was the node.
  bool resolve(double step_us, double now_us);

  std::vector<StreamTimer*> timers_;
  double total_us_ = 0;
  std::int64_t count_ = 0;
};

/// Gives the frames of one free-running stream (a node, or a bus' SYNC) their number and time from
/// counter, clock or arrival, by the lower envelope of their receive stamps (ClockLine). Pure:
/// asks no clock. Frames whose stamps disagree with the line by more than a delay could explain are
/// held until it is clear whether the node restarted, the host's clock stepped or they were late;
/// frames that arrival alone numbers also after a pause (ArrivalNumbers).
class StreamTimer {
 public:
  struct Settings {
    CanTiming kind = CanTiming::period;  ///< not sync
    double period_us = 10000;            ///< between frames
    double tick_us = 10000;              ///< device microseconds per unit of `reading`
    double modulus = 0;                  ///< units after which the reading wraps; 0: never
    double patience_us = 1e6;  ///< of late frames without a jump, before they are a new start
  };
  using Deliver = std::function<void(const TimedValues&, double time_us)>;

  StreamTimer(const Settings& settings, HostSteps& steps);
  StreamTimer(const StreamTimer&) = delete;
  StreamTimer& operator=(const StreamTimer&) = delete;

  /// To be set before the first frame.
  void on_delivery(Deliver deliver) { deliver_ = std::move(deliver); }

  /// A frame that opens a sample. `reading`: counter or clock, in its units; unused for period.
  void see(double reading, double host_us, TimedValues values);
  /// Number of the frame seen last, as far as is known.
  std::int64_t opened_number() const { return opened_.values.number; }
  /// Others know the number of the frame seen last. False when it cannot be that one. A frame that
  /// was held because of its stamp is no more in doubt: it is late, or its reading began anew.
  bool confirm(std::int64_t number);
  /// More of the sample opened last.
  void attach(TimedValues values);
  /// More of the sample `values.number`, opened before. False: it is not known when that was.
  bool attach_earlier(TimedValues values);
  /// The node said that it starts anew (CANopen boot-up).
  void restart();
  /// Gives out what is still held.
  void finish();

  double period_us() const { return settings_.period_us * line_.rate(); }
  std::int64_t restarts() const { return restarts_; }
  std::int64_t unplaced() const { return unplaced_; }  ///< frames without a believable time

  template <typename Archive>
  void archive(Archive& a) {
    archive_list(a, held_);
    archive_list(a, unnumbered_);
    a(line_, arrivals_, opened_, starting_, any_, renumber_, last_device_us_, last_host_us_);
    a(last_number_, opened_is_held_, seen_, told_any_, told_device_us_, told_us_, delivered_,
      late_);
    a(patience_, restarts_, unplaced_, origin_us_);
  }

 private:
  friend class HostSteps;
  struct Held {
    double device_us = 0, host_us = 0;
    bool timed = false;  ///< opened a sample
    TimedValues values;

    template <typename Archive>
    void archive(Archive& a) {
      a(device_us, host_us, timed, values);
    }
  };

  double device_of(double reading, double host_us) const;
  void see_arrival(double host_us, TimedValues values);
  bool decide(std::int64_t shift);
  bool unwrap(std::int64_t shift);
  void give_numbers();
  double time_of(double device_us);
  double late_us(const Held& held) const { return held.host_us - line_.host_us(held.device_us); }
  bool believable(double late_us) const;
  double absurd_us() const;
  bool goes_on(const Held& held) const;
  std::size_t timed_held() const;
  void remember(const Held& held);
  void take(Held held);
  void hold(Held held);
  void settle();
  void go_on_late();
  void give_out_held();
  void start_anew();
  void number_first();
  void shift(double step_us);

  Settings settings_;
  HostSteps& steps_;
  Deliver deliver_;
  ClockLine line_;
  std::vector<Held> held_;
  bool starting_ = true;   ///< holding frames until the line has a few
  bool any_ = false;       ///< the last_ are of this start
  bool renumber_ = false;  ///< numbers of this start go on after delivered_
  double last_device_us_ = 0, last_host_us_ = 0;
  std::int64_t last_number_ = 0;
  Held opened_{};  ///< by see(), without its values
  bool opened_is_held_ = false;
  ArrivalNumbers arrivals_;
  std::vector<Held> unnumbered_;             ///< those of arrivals_, and what was attached to them
  std::int64_t seen_ = 0;                    ///< frames on the line
  bool told_any_ = false;                    ///< of this start
  double told_device_us_ = 0, told_us_ = 0;  ///< newest time that was given out
  std::int64_t delivered_ = -1;              ///< largest number
  bool late_ = false;     ///< the stream goes on without a jump, only later than a bus explains
  int patience_ = 0;      ///< frames it may go on so
  double origin_us_ = 0;  ///< device time of the reading 0
  std::int64_t restarts_ = 0, unplaced_ = 0;
};

}  // namespace framewatch::drivers
