#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/event_report/event_report_files.h"
#include "daemon/monitor/events/raised_events.h"
#include "daemon/page/metrics/page_use.h"

namespace framewatch::daemon {

/// The metrics for Prometheus (docs/metrics.md), made of the newest LCM messages. Times are the
/// caller's: microseconds of a clock that is never set.
class Metrics {
 public:
  /// A message older than this is not shown any more, so that a dead process does not look healthy.
  static constexpr std::int64_t kFresh_us = 5'000'000;

  /// `config` must outlive this.
  explicit Metrics(const Config& config)
      : config_(config),
        reports_(config.event_report ? config.event_report->directory : std::string()) {}

  /// The channels of `framewatch serve` that only the metrics need.
  std::vector<std::string> channels() const {
    const std::string& prefix = config_.lcm.prefix;
    return {prefix + "HISTORY", prefix + "ACTIONS", prefix + "UPLINK"};
  }
  void message(const std::string& channel, const void* data, std::size_t size, std::int64_t now_us);

  /// Text format 0.0.4. use: of the page.
  std::string text(std::int64_t now_us, const PageUse& use);

 private:
  struct Newest {
    std::vector<std::uint8_t> bytes;
    std::int64_t received_us = 0;
  };
  const Config& config_;
  std::mutex mutex_;                      ///< guards what is below
  std::map<std::string, Newest> newest_;  ///< by channel without prefix
  RaisedEvents found_here_;               ///< by `framewatch serve` without [watch]
  NewestEventReport reports_;
};

}  // namespace framewatch::daemon
