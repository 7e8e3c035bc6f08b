// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
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

/// A row of the table `summary` (docs/history.md) with the number of windows of its period and the
/// end of the newest one. NaN stands for a missing value.
struct SummaryRow {
  std::int64_t start_us = 0, last_us = 0, windows = 0, observable = 0, outliers = 0, boxed = 0;
  double mean = 0, std_error = 0, min = 0, whisker_low = 0, q1 = 0, median = 0, q3 = 0,
         whisker_high = 0, max = 0;
};

/// A stored acknowledgement; `place` and `kind` are those of the event. Or a note: is_note().
struct StoredAcknowledgement {
  std::int64_t id = 0, time_us = 0;
  std::string kind, place, who, comment;
};

/// Returns true if this is a note (`framewatch note`), not an acknowledgement of an event.
bool is_note(const StoredAcknowledgement& acknowledgement);

struct SummaryPeriods {
  std::int64_t period_s = 0, count = 0, first_us = 0, last_us = 0;  ///< times are starts of periods
};

struct ChannelTotals {
  std::string name;
  std::int64_t received = 0, lost = 0, late = 0, rejected = 0, stuck = 0, clipped = 0;
};

/// One hour of a covariate of [[weather]], in the unit at the end of its name.
struct WeatherHour {
  std::string name;
  std::int64_t start_us = 0, readings = 0;
  double mean = 0, min = 0, max = 0;
};

/// A covariate and the first and last hour with a reading.
struct WeatherSpan {
  std::string name;
  std::int64_t first_us = 0, last_us = 0;
};

/// Reads the database of a history, even while another program writes it.
class SummaryQuery {
 public:
  /// Opens the database. Returns an empty string, or why it cannot be read.
  std::string open(const std::string& directory);

  std::string structure();                     ///< of the newest configuration
  std::vector<SummaryParameter> parameters();  ///< in the order of the newest configuration
  std::vector<SummaryPeriods> periods();
  /// Returns the lengths of the periods, ascending, without reading them all as periods() does.
  std::vector<std::int64_t> period_lengths();
  /// Returns the end of the newest window; nullopt without any window.
  std::optional<std::int64_t> newest_us();
  /// Returns the periods of a length that start in [from_us, to_us), in order of time.
  std::vector<SummaryRow> rows(std::int64_t parameter, std::int64_t period_s, std::int64_t from_us,
                               std::int64_t to_us);
  /// Gives the same periods to `take`, one by one.
  void visit_rows(std::int64_t parameter, std::int64_t period_s, std::int64_t from_us,
                  std::int64_t to_us, const std::function<void(const SummaryRow&)>& take);
  /// Returns the newest period in which the parameter was observable.
  std::optional<SummaryRow> newest_row(std::int64_t parameter, std::int64_t period_s);
  /// Returns the start of the first period of this length from a time on; nullopt without any.
  std::optional<std::int64_t> first_us(std::int64_t period_s, std::int64_t from_us);
  /// Returns the start of the last period of this length that starts before a time; nullopt without
  /// any.
  std::optional<std::int64_t> last_us(std::int64_t period_s, std::int64_t to_us);
  /// Returns the covariates with a known unit. Empty in a database of an older version.
  std::vector<WeatherSpan> weather_spans();
  /// Returns the hours of weather that start in [from_us, to_us), by covariate and in order of
  /// time. Empty in a database of an older version.
  std::vector<WeatherHour> weather(std::int64_t from_us, std::int64_t to_us);
  /// Gives the hours of one covariate to `take`, one by one. Not in a database of an older version.
  void visit_weather(const std::string& covariate, std::int64_t from_us, std::int64_t to_us,
                     const std::function<void(const WeatherHour&)>& take);
  /// Returns the counts of the shortest periods that start in [from_us, to_us).
  std::vector<ChannelTotals> channels(std::int64_t from_us, std::int64_t to_us);
  /// Returns the newest `most` events of [from_us, to_us), in order of time.
  std::vector<event_t> events(std::int64_t from_us, std::int64_t to_us, std::int64_t most);

  /// Returns the gravest `most` events that were raised in [from_us, to_us), of equal ones the
  /// newest, in order of time.
  std::vector<event_t> raised_events(std::int64_t from_us, std::int64_t to_us, std::int64_t most);
  /// Returns the number of events that were raised in [from_us, to_us).
  std::int64_t count_raised(std::int64_t from_us, std::int64_t to_us);
  /// Returns the newest `most` raised events of a kind, in order of time.
  std::vector<event_t> events_of(const std::string& kind, std::int64_t most);
  /// Returns the days since 1970 (UTC) on which the building was changed on purpose, as notes of
  /// kind kMaintenanceKind tell, in order.
  std::vector<std::int64_t> maintenance_days();
  /// Returns the newest `most` acknowledgements of [from_us, to_us), in order of time.
  std::vector<StoredAcknowledgement> acknowledgements(std::int64_t from_us, std::int64_t to_us,
                                                      std::int64_t most = INT64_MAX);

  /// Returns what could not be read so far; empty if all could be read.
  std::string problem() const;

 private:
  std::string told(const std::string& why) const;

  SqliteFile file_;
};

}  // namespace framewatch::daemon
