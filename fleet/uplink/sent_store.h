// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/sqlite_file.h"
#include "fleet/message/address.h"

namespace framewatch::fleet {

/// A range of sensor time in microseconds: [from_us, to_us).
struct TimeRange {
  std::int64_t from_us = 0, to_us = 0;
};

/// A command in the journal.
struct JournalEntry {
  std::string request, verb, who;
  std::int64_t time_us = 0;  ///< host clock
  std::string outcome;       ///< "done", or why it was refused
};

/// A request of the hub for raw samples.
struct RawRequest {
  std::string request;
  TimeRange time;
  std::vector<std::string> channels;  ///< names with * and ?; empty: all channels
  std::int64_t most_bytes = 0;
};

/// An acknowledged event. before: the hub already had it.
struct SentEvent {
  EventKey key;
  bool before = false;
};
/// An acknowledged period. before: the hub already had it.
struct SentPeriod {
  SummaryKey key;
  std::int64_t windows = 0;
  bool before = false;
};

/// The database `uplink.sqlite` beside a history: keys that the hub acknowledged, its requests, and
/// a journal of its commands. Stored data is on the disk when a call returns. Calls that fail
/// return false and set error().
class SentStore {
 public:
  static constexpr std::int64_t kMaxJournal = 10'000, kMaxRanges = 1000;

  /// Opens or creates the database. Sets a damaged one aside and creates a new one, after which
  /// everything is sent again. Returns an empty text, or the problem.
  std::string open(const std::string& directory, std::int64_t now_us);
  bool is_open() const { return file_.is_open(); }
  const std::string& error() const { return file_.error(); }
  daemon::SqliteFile& file() { return file_; }

  /// Stores acknowledged events and periods. clock_us: must ascend between calls, also over
  /// restarts (newest_us()). Entries with `before` keep the time of their first acknowledgement;
  /// otherwise a connection that breaks repeatedly would send them forever.
  [[nodiscard]] bool acknowledged(const std::vector<SentEvent>& events,
                                  const std::vector<SentPeriod>& periods, std::int64_t clock_us);
  /// Returns the newest `clock_us` of acknowledged(); nullopt before the first.
  std::optional<std::int64_t> newest_us();
  /// Forgets acknowledgements less than `span_us` older than the newest one.
  [[nodiscard]] bool forget_newest(std::int64_t span_us);
  /// Forgets the acknowledgements of events and periods in `time`.
  [[nodiscard]] bool forget_between(const TimeRange& time);

  /// Requests summaries of the shortest period in `time`.
  [[nodiscard]] bool want_minutes(const TimeRange& time);
  std::vector<TimeRange> wanted_minutes();

  /// Adds a command to the journal. Returns false if it is there already or cannot be stored.
  [[nodiscard]] bool note(const JournalEntry& entry);
  [[nodiscard]] bool conclude(const std::string& request, const std::string& outcome);
  std::optional<JournalEntry> journal(const std::string& request);

  [[nodiscard]] bool add_raw(const RawRequest& request);
  std::vector<RawRequest> raw_requests();  ///< oldest first
  [[nodiscard]] bool piece_acknowledged(const std::string& request, std::int64_t piece);
  std::vector<std::int64_t> pieces_acknowledged(const std::string& request);
  [[nodiscard]] bool raw_is_done(const std::string& request);

 private:
  daemon::SqliteFile file_;
};

}  // namespace framewatch::fleet
