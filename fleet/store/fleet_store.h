// SPDX-License-Identifier: MIT
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
/// A message of which the hub keeps only the newest.
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
/// A message that breaks a rule, or, with an empty reason, has an unknown type.
struct ReceivedOther {
  std::string subject, key, reason, type, version;
  Bytes content;
};
struct ReceivedFlood {
  std::string building;
  std::int64_t hour_us = 0, messages = 0, bytes = 0;
};

/// Messages that are stored in one transaction.
struct FleetBatch {
  std::vector<ReceivedEvent> events;
  std::vector<ReceivedSummary> summaries;
  std::vector<ReceivedNewest> newest;
  std::vector<ReceivedParameters> parameters;
  std::vector<ReceivedPiece> pieces;
  std::vector<ReceivedOther> others;
  std::vector<ReceivedFlood> floods;
};

/// The number of events and of periods (by length, s) of one day.
struct DayCounts {
  std::int64_t events = 0;
  std::map<std::int64_t, std::int64_t> periods;
};

/// Writes the database of a hub. Any number of programs may write at once. Storing a message twice
/// changes nothing.
class FleetStore {
 public:
  /// Opens the database if it is closed and creates or upgrades the tables. Returns an empty text,
  /// or the problem.
  std::string open(const std::string& where);
  bool is_open() const { return database_.is_open(); }
  /// Stores a batch in one transaction. Returns an empty text, or the problem; then try again,
  /// unless is_of_values().
  std::string add(const FleetBatch& batch);
  /// Returns true if the content of the batch caused the last failure of add().
  bool is_of_values() const { return of_values_; }
  /// Counts the events and periods of a building in [from_us, to_us). Returns nullopt if the
  /// database fails.
  std::optional<DayCounts> counts(const std::string& building, std::int64_t from_us,
                                  std::int64_t to_us);
  /// Returns the newest text of a kind from a building; empty if none came. Returns nullopt if the
  /// database fails.
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
  std::set<std::string> months_;            ///< existing tables
};

}  // namespace framewatch::fleet
