#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/sqlite_file.h"
#include "fleet/message/key.h"

namespace framewatch::fleet {

/// From a time until before another, us of the sensors' clock.
struct TimeRange {
  std::int64_t from_us = 0, to_us = 0;
};

/// A command as the journal keeps it.
struct JournalEntry {
  std::string request, verb, who;
  std::int64_t time_us = 0;  ///< host clock
  std::string outcome;       ///< "done", or why it was refused
};

/// Raw samples that the hub asked for.
struct RawRequest {
  std::string request;
  TimeRange time;
  std::vector<std::string> channels;  ///< names with * and ?; empty: every one
  std::int64_t most_bytes = 0;
};

/// What the hub has acknowledged. `before`: it said that it had it already.
struct SentEvent {
  EventKey key;
  bool before = false;
};
struct SentPeriod {
  SummaryKey key;
  std::int64_t windows = 0;
  bool before = false;
};

/// `uplink.sqlite` beside a history: keys of what the hub has acknowledged, what it asked for, and
/// a journal of its commands. What a call stores is on the disk when it returns. Calls that fail
/// return false; error() says why.
class SentStore {
 public:
  static constexpr std::int64_t kMaxJournal = 10'000, kMaxRanges = 1000;

  /// Opens, or makes, the database; a damaged one is set aside and a new one begun, after which
  /// everything is sent again. Empty, or why not.
  std::string open(const std::string& directory, std::int64_t now_us);
  bool is_open() const { return file_.is_open(); }
  const std::string& error() const { return file_.error(); }
  daemon::SqliteFile& file() { return file_; }

  /// The hub has these. `clock_us` ascends from call to call, over restarts too (newest_us()). What
  /// it had before keeps the time of its first acknowledgement, where that is known: else a line
  /// that breaks again and again would have it sent for ever.
  [[nodiscard]] bool acknowledged(const std::vector<SentEvent>& events,
                                  const std::vector<SentPeriod>& periods, std::int64_t clock_us);
  /// The newest `clock_us` of acknowledged(); empty when there is none.
  std::optional<std::int64_t> newest_us();
  /// What was acknowledged less than `span_us` before the newest acknowledgement counts as not
  /// acknowledged.
  [[nodiscard]] bool forget_newest(std::int64_t span_us);
  /// Likewise events and periods of these times.
  [[nodiscard]] bool forget_between(const TimeRange& time);

  /// Summaries of the shortest period are wanted of these times.
  [[nodiscard]] bool want_minutes(const TimeRange& time);
  std::vector<TimeRange> wanted_minutes();

  /// False when the request is in the journal already, or cannot be stored.
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
