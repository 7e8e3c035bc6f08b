#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/can/can_map.h"
#include "drivers/can/can_status.h"
#include "drivers/can/stream_timer.h"

namespace framewatch::drivers {

/// The frames of a bus' SYNC-latched nodes between two SYNCs, and which SYNC each belongs to: the
/// last one before it, or the one that the node's counter says. When SYNCs come late or get lost,
/// most nodes' counters tell the SYNC's number.
class SyncLatch {
 public:
  /// `deliver` gets every value with its SYNC's number and time.
  SyncLatch(const CanMap& map, int bus, HostSteps& steps, StreamTimer::Deliver deliver);

  /// The SYNC of the bus.
  void sync(const CanFrame& frame, double host_us);
  /// A frame of a node of this bus.
  void add(const CanFrame& frame, double host_us, TimedValues values);
  void finish();

  double period_us() const { return timer_.period_us(); }
  /// Adds what happened to the node's frames.
  void count(int node, CanNodeCounters& counters) const;

  template <typename Archive>
  void archive(Archive& a) {
    a(timer_, sync_us_, waiting_);
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
  struct Waiting {
    int node, message;
    std::optional<CanField> counter;
    std::optional<Arrived> first, second;  ///< and last
    int count = 0;
    bool came_last_time = true;
    std::int64_t counter_at_sync = -1;  ///< counter minus the SYNC's number; -1: not known
    std::vector<Arrived> unsure;        ///< numbered; long after their SYNC, before that is known
    int disagreements = 0;              ///< in a row, of the counter with the SYNC
    std::int64_t late = 0, duplicates = 0, unplaced = 0;

    template <typename Archive>
    void archive(Archive& a) {
      archive_optional(a, first);
      archive_optional(a, second);
      archive_list(a, unsure);
      a(count, came_last_time, counter_at_sync, disagreements, late, duplicates, unplaced);
    }
  };

  void flush();
  void agree_on_number();
  void give(Waiting& waiting);
  bool belongs(Waiting& waiting, const Arrived& arrived);
  void keep_unsure(Waiting& waiting);
  void place_unsure(Waiting& waiting);

  const CanBusMap& bus_;
  StreamTimer timer_;
  double sync_us_ = -1e18;
  std::vector<Waiting> waiting_;
};

}  // namespace framewatch::drivers
