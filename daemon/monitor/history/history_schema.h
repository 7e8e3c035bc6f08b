// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "daemon/base/sqlite_file.h"

namespace framewatch::daemon {

/// Returns the SQL that upgrades the database from version i to version i + 1, for i = 0, 1, ...
/// docs/history.md explains the tables.
std::span<const char* const> history_schema();

/// Upgrades a database to the version after the last of `steps`, each step in one transaction.
/// Returns an empty string, or the reason of a failure: a newer program wrote it, a step failed, or
/// the database has other tables, indexes, views or triggers than the steps of its version make.
/// That last one condemns the file. After a failure that step has changed nothing.
std::string upgrade(SqliteFile& file, std::span<const char* const> steps);

/// Returns why a database of another version, or with other parts than upgrade() allows, cannot be
/// read; empty if it can.
std::string version_problem(SqliteFile& file, std::span<const char* const> steps);

/// Returns why the database of a history cannot be read; empty if it can. Databases of the version
/// before can.
std::string history_read_problem(SqliteFile& file);

}  // namespace framewatch::daemon
