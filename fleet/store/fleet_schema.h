#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "fleet/store/database.h"

namespace framewatch::fleet {

/// SQL that brings the database of a hub from version i to version i + 1 (docs/fleet.md says what
/// the tables mean).
std::span<const char* const> fleet_schema();

/// Makes the tables, or brings them to this program's version, each step as one transaction; of
/// several programs that begin at once one does it. Empty, or why not: a newer program made them.
std::string upgrade(Database& database);

/// "summary_2026_11": the table with the summaries of the month, in UTC, that a time is in.
struct Month {
  std::string table;
  std::int64_t from_us = 0, to_us = 0;
};
Month month_of(std::int64_t time_us);

}  // namespace framewatch::fleet
