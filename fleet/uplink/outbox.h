// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/summary_t.hpp>

#include "daemon/base/sqlite_file.h"
#include "fleet/message/address.h"
#include "fleet/uplink/sent_store.h"

namespace framewatch::fleet {

/// A closed period of the history and the number of its windows.
struct ClosedPeriod {
  SummaryKey key;
  std::int64_t windows = 0;
};

/// The content of the history that the hub has not acknowledged. It is a set difference, because a
/// position in time could miss data when a clock jumps.
struct Waiting {
  std::vector<event_t> events;                     ///< the oldest ones, in order of time
  std::vector<ClosedPeriod> periods;               ///< newest first, at one time the longest first
  std::int64_t event_count = 0, period_count = 0;  ///< of all waiting ones
};

/// Reads the history that `framewatch run` writes. Never writes to it.
class Outbox {
 public:
  static constexpr std::size_t kMaxEvents = 1024, kMaxPeriods = 1024;

  /// directory: of the history. summary_s: its periods, ascending. If there are several, the hub
  /// gets those of the first length only on request and around events.
  Outbox(std::string directory, std::vector<std::int64_t> summary_s)
      : directory_(std::move(directory)), summary_s_(std::move(summary_s)) {}

  /// Returns true if the history may have changed since the last collect().
  bool has_news();
  /// Collects what waits. Returns an empty text, or the problem; then `out` is unchanged.
  std::string collect(SentStore& sent, Waiting& out);
  /// Returns the sensor time at which the newest window ended; nullopt before the first.
  std::optional<std::int64_t> newest_us() const { return newest_us_; }
  daemon::SqliteFile& history() { return file_; }

 private:
  std::string open();
  void collect_events(SentStore& sent, Waiting& out);
  void collect_periods(SentStore& sent, std::int64_t period_s, const TimeRange& time, Waiting& out);
  std::vector<TimeRange> wanted_minutes(SentStore& sent);

  std::string directory_;
  std::vector<std::int64_t> summary_s_;
  daemon::SqliteFile file_;
  std::int64_t version_ = -1;
  std::optional<std::int64_t> newest_us_;
};

/// Sorts ranges by time and merges those that touch.
std::vector<TimeRange> united(std::vector<TimeRange> ranges);

/// Returns the number of events and closed periods on each of the 30 days up to `newest_us` as
/// JSON:
/// {"format": "framewatch.inventory/1", "days": [{"day": "2026-11-24", "from_us": ..., "events": 3,
/// "periods": {"600": 144}}]}. Leaves out empty days and periods shorter than `least_s`. Returns an
/// empty text if the history cannot be read.
std::string inventory(daemon::SqliteFile& history, std::int64_t newest_us, std::int64_t least_s);

/// Returns a period of a history as a message. Parameters are in the order of `table` if it has the
/// period's configuration, else in the order of the history. Returns nullopt if the period is
/// missing or unreadable.
std::optional<summary_t> summary_message(daemon::SqliteFile& history, const SummaryKey& key,
                                         const std::optional<parameter_table_t>& table);

}  // namespace framewatch::fleet
