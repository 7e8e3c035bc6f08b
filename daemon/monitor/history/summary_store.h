// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/parameter_table_t.hpp>

#include "daemon/base/sqlite_file.h"
#include "daemon/config/keys/history_options.h"
#include "daemon/monitor/estimates/summary_intake.h"
#include "drivers/files/descriptor.h"

namespace framewatch::daemon {

/// Writes the database of a history: summaries of the configured periods, channels, events. Counts
/// repeated messages once: ignores windows that ended before the newest one of their period or
/// belong to a closed period.
class SummaryStore {
 public:
  explicit SummaryStore(const HistorySettings& settings) : settings_(settings) {}

  /// Opens or creates the database and upgrades it to this program's schema. Returns an empty
  /// string, or the problem, such as another program that writes it.
  std::string open();
  /// Creates the database in an empty file outside of a history. Writes fast but not safely: use
  /// the file only when it is complete.
  std::string open_new(const std::string& path);
  bool is_open() const { return file_.is_open(); }
  /// Returns true if the path no longer names the database that is open: somebody moved, removed or
  /// replaced it.
  bool is_replaced() const { return file_.is_open() && !file_.in_place(); }
  void close() { file_.close(); }
  /// Returns true if the file that was opened last is damaged.
  bool corrupt() const { return file_.corrupt(); }

  /// Returns start and end of the newest window of the shortest periods that can still grow.
  std::vector<std::pair<std::int64_t, std::int64_t>> open_periods();
  /// Stores a batch completely or not at all. It is on the disk when this returns. Returns an empty
  /// string, or the problem.
  std::string add(const SummaryBatch& batch);
  /// Returns how many periods add() ignored because their time had been summarized before.
  std::int64_t repeated() const { return repeated_; }
  /// Removes summaries of the shortest period that are older than keep_summary_days before
  /// `newest_us`. Removes nothing while that limit is before 1970.
  std::string prune(std::int64_t newest_us);

 private:
  std::string lock();
  std::string upgraded(bool opened);
  bool add_names(const SummaryBatch& batch);
  using Grown = std::set<std::pair<std::int64_t, std::int64_t>>;  ///< length and start
  bool add_period(const PeriodData& data, Grown& grown);
  bool add_longer(std::int64_t period_s, std::int64_t start_us);
  bool add_channels(const PeriodData& data);
  bool forget_values(std::int64_t newest_us);
  bool add_event(const event_t& event);
  bool add_weather(const std::vector<WeatherReading>& readings);
  bool add_acknowledged(const acknowledged_t& acknowledged);

  HistorySettings settings_;
  /// On the directory: two programs that write summaries would count every window twice. The kernel
  /// releases it when the program ends, even after a crash.
  drivers::Descriptor lock_;
  SqliteFile file_;
  std::vector<std::int64_t> parameter_ids_, channel_ids_;
  std::int64_t repeated_ = 0;
};

}  // namespace framewatch::daemon
