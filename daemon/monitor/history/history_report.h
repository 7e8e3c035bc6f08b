#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <framewatch/event_t.hpp>

#include <lcm/lcm-cpp.hpp>

#include "daemon/base/clocks.h"
#include "daemon/config/config.h"
#include "daemon/monitor/events/raised_events.h"
#include "daemon/monitor/history/history.h"
#include "daemon/monitor/history/history_monitor.h"

namespace framewatch::daemon {

/// The history of a running estimation, where one is configured, and what is to be said about it:
/// history_status_t every second, events and log lines when the disk stops or begins to take it.
class HistoryReport {
 public:
  /// Both must outlive this.
  HistoryReport(const Config& config, lcm::LCM& lcm);

  /// Null when none is configured.
  History* history() { return history_ ? &*history_ : nullptr; }
  /// Its own events that are raised.
  RaisedEvents& raised() { return raised_; }
  /// Call it several times a second. Returns the events that it published. now_us: host clock.
  std::vector<event_t> check(std::int64_t now_us);

 private:
  const Config& config_;
  lcm::LCM& lcm_;
  OnceASecond second_;
  HistoryMonitor monitor_;
  RaisedEvents raised_;
  std::optional<History> history_;
};

}  // namespace framewatch::daemon
