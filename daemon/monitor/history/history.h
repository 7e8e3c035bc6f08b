// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <framewatch/history_status_t.hpp>
#include <framewatch/temperature_t.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/history/history_keeper.h"
#include "daemon/monitor/history/raw_history.h"
#include "daemon/monitor/history/summary_history.h"

namespace framewatch::daemon {

/// Stores the history of a running estimation: raw samples, summaries, events. No call waits for
/// the disk or fails; losses are counted.
class History {
 public:
  /// `config`, which has a history, must outlive this.
  explicit History(const Config& config);
  /// Writes everything to the disk; gives up after a few seconds when the disk fails.
  ~History();
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  void sample(const estimator::AccelSample& sample) { raw_.sample(sample); }
  void temperature(const temperature_t& temperature);
  /// Stores a message that the estimation published.
  void message(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
    summaries_.message(channel, bytes);
  }
  /// Call it several times a second with the time of a steady clock.
  void tick(std::int64_t now_us);
  history_status_t status() const;
  /// Returns the corrupt databases that were set aside.
  SetAside set_aside() const { return summaries_.counters().set_aside; }

 private:
  const Config& config_;
  HistoryKeeper keeper_;
  SummaryHistory summaries_;
  RawHistory raw_;
};

}  // namespace framewatch::daemon
