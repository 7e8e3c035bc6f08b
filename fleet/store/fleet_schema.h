// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "fleet/store/database.h"

namespace framewatch::fleet {

/// Returns the SQL that upgrades the database of a hub from version i to i + 1 (docs/fleet.md
/// describes the tables).
std::span<const char* const> fleet_schema();

/// Creates the tables or upgrades them to this program's version, each step in one transaction.
/// Safe when several programs start at once. Returns an empty text, or the problem: a failure, or
/// tables of a newer program.
std::string upgrade(Database& database);

/// The table with the summaries of one UTC month: "summary_2026_11".
struct Month {
  std::string table;
  std::int64_t from_us = 0, to_us = 0;
};
Month month_of(std::int64_t time_us);

}  // namespace framewatch::fleet
