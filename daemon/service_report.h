#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <framewatch/service_t.hpp>

#include "daemon/config.h"
#include "daemon/live_estimation.h"
#include "daemon/once_a_second.h"
#include "daemon/start_count.h"
#include "daemon/state_keeper.h"

namespace framewatch::daemon {

/// What has become of requests to read the configuration anew.
struct ReloadCount {
  std::int64_t done = 0, refused = 0;
  std::string problem;  ///< why the newest one was refused; empty: it was not
};

/// Says once a second how the process of `framewatch run` is, by the host's clock: that nothing is
/// heard of it means that it is not there, not that the building sends nothing.
class ServiceReport {
 public:
  /// `config` must outlive this.
  ServiceReport(const Config& config, const StartCount& starts, bool resumed);
  /// Empty when less than a second has passed since the last one.
  std::optional<service_t> look(const LiveEstimation& live, const StateKeeper& state,
                                const ReloadCount& reloads, std::int64_t now_us);

 private:
  const Config& config_;
  StartCount starts_;
  bool resumed_;
  std::int64_t started_us_ = 0;
  OnceASecond second_;
};

}  // namespace framewatch::daemon
