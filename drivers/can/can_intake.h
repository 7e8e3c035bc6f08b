// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "drivers/can/can_map.h"
#include "drivers/can/can_status.h"
#include "drivers/can/resampler.h"
#include "drivers/can/stream_timer.h"
#include "drivers/can/sync_matcher.h"
#include "drivers/lcm/sequence_counter.h"
#include "estimator/motion/sample.h"

namespace framewatch::drivers {

/// Finds the configured messages for the id of a frame; several when messages are multiplexed.
/// Memory is bounded by the map, whatever ids arrive.
class FrameLookup {
 public:
  struct Target {
    int node, message;  ///< indexes in the map
  };

  /// Prepares the lookup for the nodes on one bus of `map`.
  FrameLookup(const CanMap& map, int bus);

  /// Returns an empty list for an id of no configured node.
  const std::vector<Target>& find(std::uint32_t id, bool extended) const;

 private:
  struct Group {
    std::uint32_t mask;
    bool extended;
    std::unordered_map<std::uint32_t, std::vector<Target>> targets;
  };
  std::vector<Group> groups_;
};

/// Turns CAN frames, live or from a log, into samples of the configured axes with their sampling
/// time. Pure: the same frames give the same samples. Never throws, whatever the frames hold, and
/// counts the frames that it rejects. Pass the frames of a bus to frame() in the order they were
/// received, then call finish().
class CanIntake {
 public:
  using Sink = std::function<void(const estimator::AccelSample&)>;
  /// One decoded value before resampling to the grid. `number` counts the samples of the node.
  struct Decoded {
    int node, axis;
    std::int64_t number;
    double time_us, value;
  };
  using Observer = std::function<void(const Decoded&)>;

  /// `map` must outlive this object. `sink` gets the samples, `observer` every decoded value.
  CanIntake(const CanMap& map, Sink sink, Observer observer = {});
  CanIntake(const CanIntake&) = delete;
  CanIntake& operator=(const CanIntake&) = delete;

  /// Sets the receiver of notices about buses and nodes. Call it before the first frame.
  void on_notice(CanNoticeSink sink) { notice_ = std::move(sink); }

  /// Receives the values of CanMap::values. stamp_us: of the frame.
  using ValueSink = std::function<void(std::size_t covariate, double value, std::int64_t stamp_us)>;
  /// Sets the receiver of values. Call it before the first frame.
  void on_value(ValueSink sink) { value_sink_ = std::move(sink); }

  /// Takes a frame of the bus with this index in the map.
  void frame(int bus, const CanFrame& frame);
  /// Ends the input: delivers the samples that wait for a next SYNC or for their time.
  void finish();

  /// Returns the index of the bus on this interface, or -1.
  int bus_of(std::string_view interface) const;
  const std::vector<CanBusCounters>& buses() const { return bus_counters_; }
  /// Returns the counters of the node with this index in the map.
  CanNodeCounters node(std::size_t index) const;
  const CanRange& range_of(std::size_t axis) const { return ranges_[axis]; }
  /// Returns the number of lost frames that would have carried the axis.
  std::int64_t lost_of(std::size_t axis) const;
  /// Returns the number of values of the axis outside CanReading::least to most, which resampling
  /// ignored.
  std::int64_t absurd_of(std::size_t axis) const {
    return axis < absurd_.size() ? absurd_[axis] : 0;
  }
  std::int64_t host_steps() const { return steps_.count(); }
  /// Returns the receive stamp of the newest frame; 0 before the first one.
  const CanMap& map() const { return map_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(steps_, nodes_, buses_, bus_counters_, resamplers_, ranges_, newest_stamp_us_, absurd_);
    a.within(next_check_us_, -2 * a.kMaxCount, 2 * a.kMaxCount);
  }

 private:
  struct Node {
    CanNodeCounters counters;
    std::vector<SequenceCounter> sequence;  ///< by message
    std::unique_ptr<StreamTimer> timer;     ///< null when the SYNC gives the time
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
  void check_nodes(std::int64_t stamp_us);
  bool values(int bus, const CanFrame& frame) const;
  void message(int node, int message, const CanFrame& frame, double host_us);
  void place(Node& node, int message, const CanFrame& frame, TimedValues values, double host_us);
  bool known(const TimedValues& values) const;
  /// `period_us` is the current time between frames of the node.
  void deliver(const TimedValues& values, double time_us, double period_us);

  const CanMap& map_;
  Sink sink_;
  Observer observer_;
  CanNoticeSink notice_;
  ValueSink value_sink_;
  HostClockSteps steps_;
  std::vector<Node> nodes_;
  std::vector<Bus> buses_;
  std::vector<CanBusCounters> bus_counters_;
  std::vector<Resampler> resamplers_;  ///< by axis; empty when the nodes share their instants
  std::vector<CanRange> ranges_;       ///< by axis
  std::vector<std::int64_t> absurd_;   ///< by axis
  std::vector<std::pair<int, int>> carrier_;  ///< by axis: node and message; -1: not on CAN
  std::int64_t newest_stamp_us_ = 0, next_check_us_ = 0;
};

}  // namespace framewatch::drivers
