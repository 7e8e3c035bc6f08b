#pragma once

#include <span>
#include <string>

#include "daemon/sqlite_file.h"

namespace framewatch::daemon {

/// SQL that brings the database from version i to version i + 1, for i = 0, 1, ...; docs/history.md
/// says what the tables mean.
std::span<const char* const> history_schema();

/// Brings a database to the version that `steps` lead to, each step as one transaction. Empty, or
/// why not: a newer program wrote it, or a step failed; then it is as it was.
std::string upgrade(SqliteFile& file, std::span<const char* const> steps);

/// Why a database that is only read cannot be: its version is another one.
std::string version_problem(SqliteFile& file, std::span<const char* const> steps);

}  // namespace framewatch::daemon
