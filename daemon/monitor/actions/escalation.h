// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <framewatch/event_t.hpp>

namespace framewatch::daemon {

/// Decides which receivers get an event, in their order: the first one at once, each other one when
/// the event is still not acknowledged some time after the one before. Uses no clock: callers
/// pass the time of a clock that is never set.
class Escalation {
 public:
  static constexpr std::size_t kMax = 1000;  ///< events; with more, the oldest goes no further

  /// An event that a receiver has to get now.
  struct Due {
    std::size_t receiver;  ///< 0 for the first
    event_t event;         ///< with a remark in its message
  };

  /// `receivers`: their number; with fewer than two, nothing escalates.
  void configure(std::size_t receivers, double after_min);
  /// Notes an event. Returns how many receivers, counted from the first, have to get it now.
  /// Those that never got it ignore its end.
  std::size_t event(const event_t& event, bool acknowledged, std::int64_t now_us);
  /// Tells that the event was acknowledged: it goes no further.
  void acknowledged(const event_t& event);
  /// Returns the events to tell further receivers of. The time of events below `least_severity`,
  /// which wait for the end of quiet hours, begins anew.
  std::vector<Due> due(int least_severity, std::int64_t now_us);

 private:
  using Key = std::pair<std::string, std::int64_t>;  ///< kind and id
  struct Open {
    event_t event;
    std::size_t told;  ///< receivers
    std::int64_t next_us;
  };

  std::size_t receivers_ = 0;
  double after_min_ = 0;
  std::map<Key, Open> open_;
};

}  // namespace framewatch::daemon
