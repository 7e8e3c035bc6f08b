#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/reception_t.hpp>
#include <framewatch/service_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/monitor/events/raised_events.h"
#include "daemon/monitor/live/live_estimation.h"
#include "daemon/monitor/live/state_keeper.h"
#include "daemon/monitor/service/start_count.h"

namespace framewatch::daemon {

/// Outcome of the requests to read the configuration anew.
struct ReloadCount {
  std::int64_t done = 0, refused = 0;
  std::string problem;  ///< why the newest one was refused; empty: accepted
};

/// What LCM's receiver has not taken so far. now_us: host clock.
reception_t reception_report(const LiveEstimation& live, std::int64_t now_us);

/// Reports once a second of the host's clock how the process of `framewatch run` is, whether
/// samples come or not: a missing report means that the process is not running.
class ServiceReport {
 public:
  ServiceReport(const StartCount& starts, bool resumed);
  /// The report; empty when less than a second has passed since the last one. raised: every event
  /// of this process that is raised.
  std::optional<service_t> look(const LiveEstimation& live,
                                const std::vector<RaisedEvents*>& raised, const StateKeeper& state,
                                const ReloadCount& reloads, std::int64_t now_us);

 private:
  StartCount starts_;
  bool resumed_;
  std::int64_t started_us_ = 0;
  OnceASecond second_;
};

}  // namespace framewatch::daemon
