// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/can/can_map.h"
#include "drivers/can/can_status.h"
#include "drivers/can/stream_timer.h"

namespace framewatch::drivers {

/// Assigns frames of the nodes that sample at the SYNC to their SYNC: the last one before the
/// frame, or the one that the counter of the node names. When SYNCs come late or are lost, the
/// counters of most nodes give the number of the SYNC.
class SyncMatcher {
 public:
  /// `map` must outlive this object. `deliver` gets the values of every frame with number and time
  /// of its SYNC.
  SyncMatcher(const CanMap& map, int bus, HostClockSteps& steps, StreamTimer::Deliver deliver);

  /// Takes a SYNC of the bus.
  void sync(const CanFrame& frame, double host_us);
  /// Takes a frame of a node of this bus.
  void add(const CanFrame& frame, double host_us, TimedValues values);
  /// Ends the input and delivers the frames after the last SYNC.
  void finish();

  double period_us() const { return timer_.period_us(); }
  /// Adds the late, repeated and unplaced frames of the node to `counters`.
  void count(int node, CanNodeCounters& counters) const;

  template <typename Archive>
  void archive(Archive& a) {
    a(timer_, sync_us_, streams_);
  }

 private:
  struct Arrived {
    TimedValues values;
    std::int64_t counter = 0;
    bool in_window = true;

    template <typename Archive>
    void archive(Archive& a) {
      a(values, counter, in_window);
    }
  };
  /// One message of a node.
  struct Stream {
    int node, message;
    std::optional<CanField> counter;
    std::optional<Arrived> first, last;  ///< since the SYNC
    int count = 0;
    bool came_after_last_sync = true;
    std::int64_t counter_at_sync = -1;  ///< counter minus number of the SYNC; -1: unknown
    std::vector<Arrived> unassigned;    ///< came long after a SYNC while counter_at_sync is unknown
    int disagreements = 0;              ///< of counter and SYNC, in a row
    std::int64_t late = 0, duplicates = 0, unplaced = 0;

    template <typename Archive>
    void archive(Archive& a) {
      archive_optional(a, first);
      archive_optional(a, last);
      archive_vector(a, unassigned);
      a(count, came_after_last_sync, counter_at_sync, disagreements, late, duplicates, unplaced);
    }
  };

  void flush();
  void vote_on_number();
  void deliver(Stream& stream);
  bool belongs_to_sync(Stream& stream, const Arrived& arrived);
  void keep_unassigned(Stream& stream);
  void assign_kept(Stream& stream);

  const CanBusMap& bus_;
  StreamTimer timer_;
  double sync_us_ = -1e18;
  std::vector<Stream> streams_;
};

}  // namespace framewatch::drivers
