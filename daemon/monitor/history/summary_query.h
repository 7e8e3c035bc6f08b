#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>

#include "daemon/base/sqlite_file.h"

namespace framewatch::daemon {

struct SummaryParameter {
  std::int64_t id = 0;
  std::string name, unit;
};

/// A row of the table `summary` (docs/history.md) with its period's windows and end of the newest
/// of them; NaN for a value that is missing.
struct SummaryRow {
  std::int64_t start_us = 0, last_us = 0, windows = 0, observable = 0, outliers = 0, boxed = 0;
  double mean = 0, std_error = 0, min = 0, whisker_low = 0, q1 = 0, median = 0, q3 = 0,
         whisker_high = 0, max = 0;
};

/// An event was acknowledged; `place` and `kind` are the event's.
struct StoredAcknowledgement {
  std::int64_t id = 0, time_us = 0;
  std::string kind, place, who, comment;
};

struct SummaryPeriods {
  std::int64_t period_s = 0, count = 0, first_us = 0, last_us = 0;  ///< starts
};

struct ChannelTotals {
  std::string name;
  std::int64_t received = 0, lost = 0, late = 0, rejected = 0, stuck = 0, clipped = 0;
};

/// Reads the database of a history, also while another program writes it.
class SummaryQuery {
 public:
  /// Returns an empty string, or why the database cannot be read.
  std::string open(const std::string& directory);

  std::string structure();                     ///< of the newest configuration
  std::vector<SummaryParameter> parameters();  ///< in the order of the newest configuration
  std::vector<SummaryPeriods> periods();
  /// End of the newest window; empty when there is none.
  std::optional<std::int64_t> newest_us();
  std::vector<SummaryRow> rows(std::int64_t parameter, std::int64_t period_s, std::int64_t from_us,
                               std::int64_t to_us);
  /// The newest period in which the parameter was observable.
  std::optional<SummaryRow> newest_row(std::int64_t parameter, std::int64_t period_s);
  /// Counts of the shortest periods that start between two times.
  std::vector<ChannelTotals> channels(std::int64_t from_us, std::int64_t to_us);
  /// In order of time; the newest `most`.
  std::vector<event_t> events(std::int64_t from_us, std::int64_t to_us, std::int64_t most);

  /// In order of time.
  std::vector<StoredAcknowledgement> acknowledgements(std::int64_t from_us, std::int64_t to_us);

  /// Empty unless something could not be read.
  std::string problem() const;

 private:
  std::string told(const std::string& why) const;

  SqliteFile file_;
};

}  // namespace framewatch::daemon
