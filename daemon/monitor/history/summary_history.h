// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "daemon/base/sqlite_file.h"
#include "daemon/config/config.h"
#include "daemon/monitor/estimates/summary_intake.h"
#include "daemon/monitor/history/summary_store.h"

namespace framewatch::daemon {

/// Stores summaries, channels and events of a running estimation in the database, from a thread.
/// message() never waits. While the database cannot be written, a limited number of periods waits
/// and is tried again every second. A database that is corrupt or another program's, or that
/// somebody has moved, removed or replaced, is set aside; a new one starts with the events that
/// could still be read.
class SummaryHistory {
 public:
  static constexpr std::size_t kQueueBytes = std::size_t{32} << 20;
  static constexpr std::size_t kMaxPeriods = 240;  ///< that wait
  static constexpr std::size_t kMaxEvents = 10000;

  struct Counters {
    std::int64_t commits = 0, until_us = 0;
    std::int64_t dropped = 0;  ///< windows and events
    std::string trouble;
    SetAside set_aside;
  };

  /// `config`, which has a history, must outlive this.
  explicit SummaryHistory(const Config& config);

  /// Takes a message that the estimation published. Ignores all but estimates of the main window,
  /// tables, statuses, events and acknowledgements.
  void message(const std::string& channel, const std::vector<std::uint8_t>& bytes);
  Counters counters() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Message {
    SummaryIntake::Kind kind;
    std::vector<std::uint8_t> bytes;
  };

  void work(const std::stop_token& stop);
  void guarded(std::size_t messages, const std::function<void()>& round);
  void commit();
  std::string store_waiting();
  std::vector<event_t> readable_events() const;
  bool begin_anew(const std::string& reason, const std::vector<event_t>& readable);
  void bound();
  SummaryBatch& waiting() { return intake_.batch(); }

  const Config& config_;

  // Used only by the thread.
  SummaryStore store_;
  SummaryIntake intake_;  ///< any thread may call kind_of()
  Clock::time_point next_commit_, next_prune_;
  std::int64_t repeated_said_ = 0;

  mutable std::mutex mutex_;  ///< guards the members below
  std::condition_variable_any wake_;
  std::vector<Message> queue_;
  std::size_t queued_ = 0;  ///< bytes
  Counters counters_;
  /// Last, because it uses the members above. At the end it tries once to commit the waiting data.
  std::jthread thread_;
};

}  // namespace framewatch::daemon
