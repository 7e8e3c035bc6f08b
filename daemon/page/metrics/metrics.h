// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/event_report/event_report_files.h"
#include "daemon/monitor/events/raised_events.h"
#include "daemon/monitor/service/latest_messages.h"

namespace framewatch::daemon {

/// The connections of the page now, and those that it has ended since its start.
struct PageUse {
  int waiting = 0;    ///< connections whose request is incomplete
  int answering = 0;  ///< connections that read an answer
  int viewers = 0;    ///< connections that read the event stream

  std::int64_t late_requests = 0;    ///< ended: request not complete in time
  std::int64_t late_answers = 0;     ///< ended: answer not read in time
  std::int64_t crowded_out = 0;      ///< ended to make room for newer ones
  std::int64_t viewers_refused = 0;  ///< refused: all viewer places taken
};

/// Makes the metrics for Prometheus (docs/metrics.md) from the latest LCM messages. Call message()
/// with every message and text() for every scrape, from any threads.
class Metrics {
 public:
  /// Messages older than this are left out, so that a dead process does not look healthy.
  static constexpr std::int64_t kFresh_us = 5'000'000;

  /// `config` must outlive this.
  explicit Metrics(const Config& config)
      : config_(config),
        latest_(config.lcm.prefix),
        reports_(config.event_report ? config.event_report->directory : std::string()) {}

  /// Returns the LCM channels of `framewatch serve` that only the metrics need.
  std::vector<std::string> channels() const {
    return latest_.channels(
        {DaemonMessage::history, DaemonMessage::actions, DaemonMessage::uplink});
  }
  /// Takes one LCM message. Ignores other channels and malformed payloads. now_us: monotonic clock.
  void message(const std::string& channel, const void* data, std::size_t size, std::int64_t now_us);

  /// Returns all metrics in Prometheus text format 0.0.4. now_us: the clock of message(). use: of
  /// the page, now.
  std::string text(std::int64_t now_us, const PageUse& use);

 private:
  const Config& config_;
  std::mutex mutex_;  ///< guards the members below
  LatestMessages latest_;
  std::map<DaemonMessage, std::int64_t> received_us_;
  RaisedEvents found_here_;  ///< changes that `framewatch serve` finds without [watch]
  NewestEventReport reports_;
};

}  // namespace framewatch::daemon
