#pragma once

#include <span>
#include <string>

#include "daemon/base/sqlite_file.h"

namespace framewatch::daemon {

/// SQL that brings the database from version i to version i + 1, for i = 0, 1, ...; docs/history.md
/// says what the tables mean.
std::span<const char* const> history_schema();

/// Upgrades a database to the version after the last of `steps`, each step as one transaction.
/// Returns an empty string, or the reason of a failure: a newer program wrote it, or a step failed;
/// then the database is unchanged.
std::string upgrade(SqliteFile& file, std::span<const char* const> steps);

/// Why a database cannot be read: it has another version. Empty when it can.
std::string version_problem(SqliteFile& file, std::span<const char* const> steps);

}  // namespace framewatch::daemon
