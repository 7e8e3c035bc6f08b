#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/summary_t.hpp>

#include "fleet/message/message.h"
#include "fleet/store/database.h"

namespace framewatch::fleet {

struct ReceivedEvent {
  std::string building;
  event_t event;
};
struct ReceivedSummary {
  std::string building;
  summary_t summary;
};
/// What the hub keeps the newest of.
struct ReceivedNewest {
  std::string building, kind, type;
  Bytes content;
};
struct ReceivedParameters {
  std::string building;
  parameter_table_t table;
};
struct ReceivedPiece {
  std::string building, request, file;
  std::int32_t piece = 0, pieces = 0;
  Bytes content;
};
/// A message that breaks a rule, or (reason empty) of a type that this program does not know.
struct ReceivedOther {
  std::string subject, key, reason, type, version;
  Bytes content;
};
struct ReceivedFlood {
  std::string building;
  std::int64_t hour_us = 0, messages = 0, bytes = 0;
};

/// What is stored at once.
struct FleetBatch {
  std::vector<ReceivedEvent> events;
  std::vector<ReceivedSummary> summaries;
  std::vector<ReceivedNewest> newest;
  std::vector<ReceivedParameters> parameters;
  std::vector<ReceivedPiece> pieces;
  std::vector<ReceivedOther> others;
  std::vector<ReceivedFlood> floods;
};

/// How many events and periods (by their length, s) there are of a day.
struct DayCounts {
  std::int64_t events = 0;
  std::map<std::int64_t, std::int64_t> periods;
};

/// The database of a hub as it is written, by any number of programs at once. What is there already
/// changes nothing.
class FleetStore {
 public:
  /// Opens when it is not, and makes or upgrades the tables. Empty, or why not.
  std::string open(const std::string& where);
  bool is_open() const { return database_.is_open(); }
  /// All of it or nothing, in one transaction. Empty, or why not: it is to be tried again, unless
  /// is_of_values().
  std::string add(const FleetBatch& batch);
  /// Whether the last add() failed because of what is in the batch.
  bool is_of_values() const { return of_values_; }
  /// Of a building, from a time until before another. Empty when the database is away.
  std::optional<DayCounts> counts(const std::string& building, std::int64_t from_us,
                                  std::int64_t to_us);
  /// What a building said last of a kind that is text; an empty text when it said nothing. Empty
  /// when the database is away.
  std::optional<std::string> newest_text(const std::string& building, const std::string& kind);
  void close();

 private:
  bool add_buildings(const FleetBatch& batch);
  bool add_months(const FleetBatch& batch);
  bool add_all(const FleetBatch& batch);
  std::string id_of(const std::string& building) const;

  Database database_;
  bool upgraded_ = false, of_values_ = false;
  std::map<std::string, std::string> ids_;  ///< of buildings, by name
  std::set<std::string> months_;            ///< tables that are there
};

}  // namespace framewatch::fleet
