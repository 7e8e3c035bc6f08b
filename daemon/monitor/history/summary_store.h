#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/parameter_table_t.hpp>

#include "daemon/base/sqlite_file.h"
#include "daemon/config/keys/history_options.h"
#include "daemon/monitor/estimates/summary_intake.h"

namespace framewatch::daemon {

/// A lock, because two programs that write summaries would count every window twice. The kernel
/// releases it when the program ends, even by a crash.
class HistoryLock {
 public:
  HistoryLock() = default;
  ~HistoryLock();
  HistoryLock(const HistoryLock&) = delete;
  HistoryLock& operator=(const HistoryLock&) = delete;

  /// Takes the lock and keeps it. Returns an empty string, or the reason of a failure.
  std::string take(const std::string& directory);

 private:
  int file_ = -1;
};

/// The database of a history as it is written: summaries of the configured periods, channels,
/// events. Repeated messages count once: windows that ended before
/// the newest one of their period, or belong to a period that is closed, are left out.
class SummaryStore {
 public:
  explicit SummaryStore(const HistorySettings& settings) : settings_(settings) {}

  /// Opens, or makes, the database and brings it to this program's schema. Empty, or why not:
  /// another program may be writing it.
  std::string open();
  /// Makes the database in an empty file that nothing else writes, outside of a history, and fast:
  /// it is to be kept only when it is whole.
  std::string open_new(const std::string& path);
  bool is_open() const { return file_.is_open(); }
  void close() { file_.close(); }
  /// Whether the file that was opened last is damaged.
  bool corrupt() const { return file_.corrupt(); }

  /// Start and newest window's end of the shortest periods that can still grow.
  std::vector<std::pair<std::int64_t, std::int64_t>> open_periods();
  /// All of it or nothing, as one transaction that is on the disk afterwards. Empty, or why not.
  std::string add(const SummaryBatch& batch);
  /// Periods that were left out, by add(), because their time had been summarised before.
  std::int64_t repeated() const { return repeated_; }
  /// Removes summaries of the shortest period older than keep_summary_days before `newest_us`; none
  /// while that is before 1970.
  std::string prune(std::int64_t newest_us);

 private:
  bool add_names(const SummaryBatch& batch);
  using Grown = std::set<std::pair<std::int64_t, std::int64_t>>;  ///< length and start
  bool add_period(const PeriodData& data, Grown& grown);
  bool add_longer(std::int64_t period_s, std::int64_t start_us);
  bool add_channels(const PeriodData& data);
  bool forget_values(std::int64_t newest_us);
  bool add_event(const event_t& event);
  bool add_acknowledged(const acknowledged_t& acknowledged);

  HistorySettings settings_;
  HistoryLock lock_;
  SqliteFile file_;
  std::vector<std::int64_t> parameter_ids_, channel_ids_;
  std::int64_t repeated_ = 0;
};

}  // namespace framewatch::daemon
