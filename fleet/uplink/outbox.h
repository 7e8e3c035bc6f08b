#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/summary_t.hpp>

#include "daemon/base/sqlite_file.h"
#include "fleet/message/key.h"
#include "fleet/uplink/sent_store.h"

namespace framewatch::fleet {

/// A closed period of the history, and how many windows it has.
struct ClosedPeriod {
  SummaryKey key;
  std::int64_t windows = 0;
};

/// What the history holds and the hub has not acknowledged: a set difference, with no cursor in
/// time that a clock could jump over.
struct Waiting {
  std::vector<event_t> events;        ///< the oldest, by their time
  std::vector<ClosedPeriod> periods;  ///< the newest first, of one time the longest first
  std::int64_t event_count = 0, period_count = 0;  ///< of all that wait
};

/// Reads the history that `framewatch run` writes, and never writes it.
class Outbox {
 public:
  static constexpr std::size_t kMaxEvents = 1024, kMaxPeriods = 1024;

  /// directory: of the history. summary_s: its periods, ascending; those of the first go to the hub
  /// on request and around events, if there are others.
  Outbox(std::string directory, std::vector<std::int64_t> summary_s)
      : directory_(std::move(directory)), summary_s_(std::move(summary_s)) {}

  /// Whether the history has changed since the last look(), or may have.
  bool has_news();
  /// Empty, or why it cannot be read; then `out` is unchanged.
  std::string look(SentStore& sent, Waiting& out);
  /// Sensor time that the history's newest window ended; empty while there is none.
  std::optional<std::int64_t> newest_us() const { return newest_us_; }
  daemon::SqliteFile& history() { return file_; }

 private:
  std::string open();
  void look_for_events(SentStore& sent, Waiting& out);
  void look_for_periods(SentStore& sent, std::int64_t period_s, const TimeRange& time,
                        Waiting& out);
  std::vector<TimeRange> wanted_minutes(SentStore& sent);

  std::string directory_;
  std::vector<std::int64_t> summary_s_;
  daemon::SqliteFile file_;
  std::uint64_t device_ = 0, number_ = 0;  ///< of the file that is open
  std::int64_t version_ = -1;
  std::optional<std::int64_t> newest_us_;
};

/// Ranges in order of time, those that touch made one.
std::vector<TimeRange> united(std::vector<TimeRange> ranges);

/// How many events and closed periods the history has of each day of the 30 before `newest_us`, as
/// JSON: {"format": "framewatch.inventory/1", "days": [{"day": "2026-11-24", "from_us": ...,
/// "events": 3, "periods": {"600": 144}}]}. Days without any are left out; periods shorter than
/// `least_s` too. Empty when the history cannot be read.
std::string inventory(daemon::SqliteFile& history, std::int64_t newest_us, std::int64_t least_s);

/// A period of a history as a message. Parameters are in the order of `table` where that is of the
/// configuration of the period's time, else in that of the history. Empty when the period is not
/// there or cannot be read.
std::optional<summary_t> summary_message(daemon::SqliteFile& history, const SummaryKey& key,
                                         const std::optional<parameter_table_t>& table);

}  // namespace framewatch::fleet
