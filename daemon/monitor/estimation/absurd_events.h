#pragma once

#include <cstdint>
#include <vector>

#include <framewatch/event_t.hpp>

#include "estimator/motion/sample_merger.h"
#include "estimator/structure/sensors.h"

namespace framewatch::daemon {

/// Says which channels send values that no sensor can have measured (AxisCounters::absurd): an
/// event for each, raised with the first one and cleared when none has come for kQuiet_s. The id
/// depends on the channel alone and is larger than the ids of alarms and of CAN events.
class AbsurdEvents {
 public:
  static constexpr std::int64_t kQuiet_s = 600;

  /// `axes` must outlive this.
  explicit AbsurdEvents(const std::vector<estimator::SensorAxis>& axes);

  /// counters: by axis; time_us: sensor time. What is raised or cleared since the last call.
  std::vector<event_t> look(const std::vector<estimator::AxisCounters>& counters,
                            std::int64_t time_us);

  template <typename Archive>
  void archive(Archive& a) {
    a(channels_);
  }

 private:
  struct Channel {
    std::int64_t seen = 0, before = 0;  ///< absurd samples: so far, and when it was raised
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
  event_t event_of(std::size_t axis, std::int64_t time_us) const;

  const std::vector<estimator::SensorAxis>& axes_;
  std::vector<Channel> channels_;
};

}  // namespace framewatch::daemon
