#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "drivers/can/can_map.h"
#include "drivers/can/can_notice.h"
#include "drivers/can/can_status.h"
#include "drivers/can/frame_lookup.h"
#include "drivers/can/resampler.h"
#include "drivers/can/stream_timer.h"
#include "drivers/can/sync_matcher.h"
#include "drivers/lcm/sequence_counter.h"
#include "drivers/lcm/sequence_watch.h"
#include "estimator/motion/sample.h"

namespace framewatch::drivers {

/// Turns CAN frames, live or from a log, into samples of the configured axes with the time they
/// were taken at. Pure: the same frames give the same samples. Never throws on any frame; counts
/// what it does not take. Frames of one bus come in the order they were received.
class CanIntake {
 public:
  using Sink = std::function<void(const estimator::AccelSample&)>;
  /// One decoded value before it is brought to the grid; `number` counts the node's samples.
  struct Decoded {
    int node, axis;
    std::int64_t number;
    double time_us, value;
  };
  using Observer = std::function<void(const Decoded&)>;

  /// `map` must outlive this.
  CanIntake(const CanMap& map, Sink sink, Observer observer = {});
  CanIntake(const CanIntake&) = delete;
  CanIntake& operator=(const CanIntake&) = delete;

  /// Hears what the frames say of buses and nodes. To be set before the first frame.
  void on_notice(CanNoticeSink sink) { notice_ = std::move(sink); }

  void frame(int bus, const CanFrame& frame);
  /// The input has ended: gives out what waits for a next SYNC or for its time.
  void finish();

  /// Index of the bus on this interface; -1 when there is none.
  int bus_of(std::string_view interface) const;
  const std::vector<CanBusCounters>& buses() const { return bus_counters_; }
  CanNodeCounters node(std::size_t index) const;
  const CanRange& range_of(std::size_t axis) const { return ranges_[axis]; }
  /// Frames lost that would have carried the axis.
  std::int64_t lost_of(std::size_t axis) const;
  /// Values of the axis outside CanReading::least to most that no instant was resampled from.
  std::int64_t absurd_of(std::size_t axis) const {
    return axis < absurd_.size() ? absurd_[axis] : 0;
  }
  std::int64_t host_steps() const { return steps_.count(); }
  /// Host's time of the newest frame, 0 before any.
  std::int64_t newest_stamp_us() const { return newest_stamp_us_; }
  const CanMap& map() const { return map_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(steps_, nodes_, buses_, bus_counters_, resamplers_, ranges_, newest_stamp_us_, absurd_);
    a.within(next_look_us_, -2 * a.kMaxCount, 2 * a.kMaxCount);
  }

 private:
  struct Node {
    CanNodeCounters counters;
    std::vector<SequenceCounter> sequence;  ///< by message
    std::unique_ptr<StreamTimer> timer;     ///< null when SYNC gives the time
    double opened_us = -1e18;               ///< stamp of the frame that opened the sample
    std::vector<std::uint8_t> attached;     ///< by message, to that sample
    SequenceWatch watch;

    template <typename Archive>
    void archive(Archive& a) {
      a(counters, sequence, opened_us, attached, watch);
      if (timer) a(*timer);
    }
  };
  struct Bus {
    FrameLookup lookup;
    std::unique_ptr<SyncMatcher> latch;  ///< null when no node needs it

    template <typename Archive>
    void archive(Archive& a) {
      if (latch) a(*latch);
    }
  };

  void make_node(const CanNodeMap& node);
  bool canopen(int bus, const CanFrame& frame);
  void notice(const CanNotice& notice) const;
  void look(std::int64_t stamp_us);
  void message(int node, int message, const CanFrame& frame, double host_us);
  void place(Node& node, int message, const CanFrame& frame, TimedValues values, double host_us);
  /// `period_us` is between the node's frames now.
  bool known(const TimedValues& values) const;
  void deliver(const TimedValues& values, double time_us, double period_us);

  const CanMap& map_;
  Sink sink_;
  Observer observer_;
  CanNoticeSink notice_;
  HostClockSteps steps_;
  std::vector<Node> nodes_;
  std::vector<Bus> buses_;
  std::vector<CanBusCounters> bus_counters_;
  std::vector<Resampler> resamplers_;  ///< by axis; empty when the nodes share their instants
  std::vector<CanRange> ranges_;       ///< by axis
  std::vector<std::int64_t> absurd_;   ///< by axis
  std::vector<std::pair<int, int>> carrier_;  ///< by axis: node and message; -1: not on CAN
  std::int64_t newest_stamp_us_ = 0, next_look_us_ = 0;
};

}  // namespace framewatch::drivers
