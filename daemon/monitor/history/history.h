// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include <framewatch/event_t.hpp>
#include <framewatch/history_status_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/base/sqlite_file.h"
#include "daemon/config/config.h"
#include "daemon/monitor/events/raised_events.h"
#include "daemon/monitor/history/history_keeper.h"
#include "daemon/monitor/history/loss_monitor.h"
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

  void sample(const estimator::AccelSample& sample) { raw_.sample(sample); }
  /// Stores a message about weather among the raw samples.
  void weather(const std::string& channel, std::int64_t time_us,
               const std::vector<std::uint8_t>& bytes) {
    raw_.message(channel, time_us, bytes);
  }
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

/// Raises an event when samples or summaries cannot be written to the disk, and clears it, with the
/// number of losses, when writing works again. Raises another one when a corrupt, foreign or
/// removed database was set aside; it stays until the program ends, because the operator has to
/// look at it.
class HistoryMonitor {
 public:
  /// Returns the events since the last call. `now_us`: host clock.
  std::vector<event_t> update(std::int64_t now_us, const history_status_t& status,
                              const SetAside& set_aside = {});

 private:
  struct Part {
    std::int64_t since_us = 0, id = 0, lost_before = 0, lost_seen = 0, well_since_us = 0;
    bool raised = false;
  };
  std::optional<event_t> news(Part& part, const char* place, const std::string& trouble,
                              std::int64_t lost, const history_status_t& status,
                              std::int64_t now_us);

  std::optional<event_t> new_database(const SetAside& set_aside, const history_status_t& status,
                                      std::int64_t now_us);

  Part raw_, summaries_;
  std::int64_t set_aside_seen_ = 0;
  event_t database_{};
};

/// Owns the history of a running estimation, if one is configured, and reports on it:
/// history_status_t every second, events and log lines when writing fails or works again. With
/// [watch] it also finds lasting losses.
class HistoryReport {
 public:
  /// `config` and `lcm` must outlive this.
  HistoryReport(const Config& config, lcm::LCM& lcm);

  /// Returns nullptr if no history is configured.
  History* history() { return history_ ? &*history_ : nullptr; }
  /// Writes everything to the disk and ends the history.
  void close() {
    losses_.reset();
    history_.reset();
  }
  /// Returns its raised events.
  RaisedEvents& raised() { return raised_; }
  /// Stores what is due and publishes. Call it several times a second; `now_us`: host clock.
  /// Returns the events that it published.
  std::vector<event_t> update(std::int64_t now_us);

 private:
  std::vector<event_t> losses(const history_status_t& status, std::int64_t now_us);

  const Config& config_;
  lcm::LCM& lcm_;
  OnceASecond second_;
  HistoryMonitor monitor_;
  RaisedEvents raised_;
  std::optional<History> history_;
  std::optional<LossMonitor> losses_;
  RateLimitedLog unread_{LogLevel::warning};
};

}  // namespace framewatch::daemon
