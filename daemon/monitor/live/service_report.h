// SPDX-License-Identifier: MIT
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

/// The outcome of the requests to reload the configuration.
struct ReloadCount {
  std::int64_t done = 0, refused = 0;
  std::string problem;  ///< why the newest one was refused; empty: accepted
};

/// Returns how many messages and datagrams LCM's receiver has dropped. `now_us`: host clock.
reception_t reception_report(const LiveEstimation& live, std::int64_t now_us);

/// Reports on the process of `framewatch run` once a second of the host's clock, even without
/// samples: a missing report means that the process does not run.
class ServiceReport {
 public:
  ServiceReport(const StartCount& starts, bool resumed);
  /// Returns the report, or nullopt within a second after the last one. `raised` holds all raised
  /// events of this process.
  std::optional<service_t> collect(const LiveEstimation& live,
                                   const std::vector<RaisedEvents*>& raised,
                                   const StateKeeper& state, const ReloadCount& reloads,
                                   std::int64_t now_us);

 private:
  StartCount starts_;
  bool resumed_;
  std::int64_t started_us_ = 0;
  OnceASecond second_;
};

}  // namespace framewatch::daemon
