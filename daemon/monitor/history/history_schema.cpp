// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/history_schema.h"

#include <map>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

constexpr const char* kSteps[] = {
    R"sql(
CREATE TABLE config (
  sha256    TEXT PRIMARY KEY,
  structure TEXT NOT NULL,
  version   TEXT NOT NULL,
  first_us  INTEGER NOT NULL
) WITHOUT ROWID;
CREATE TABLE parameter (
  id    INTEGER PRIMARY KEY,
  name  TEXT NOT NULL,
  unit  TEXT NOT NULL,
  kind  INTEGER NOT NULL,
  story INTEGER NOT NULL,
  UNIQUE (name, unit)
);
CREATE TABLE period (
  period_s INTEGER NOT NULL,
  start_us INTEGER NOT NULL,
  windows  INTEGER NOT NULL,
  last_us  INTEGER NOT NULL,
  open     INTEGER NOT NULL,
  PRIMARY KEY (period_s, start_us)
) WITHOUT ROWID;
CREATE TABLE summary (
  parameter    INTEGER NOT NULL REFERENCES parameter,
  period_s     INTEGER NOT NULL,
  start_us     INTEGER NOT NULL,
  observable   INTEGER NOT NULL,
  mean         REAL,
  std_error    REAL,
  min          REAL,
  whisker_low  REAL,
  q1           REAL,
  median       REAL,
  q3           REAL,
  whisker_high REAL,
  max          REAL,
  outliers     INTEGER,
  boxed        INTEGER NOT NULL,
  PRIMARY KEY (parameter, period_s, start_us)
) WITHOUT ROWID;
CREATE TABLE open_values (
  parameter INTEGER NOT NULL REFERENCES parameter,
  start_us  INTEGER NOT NULL,
  box       BLOB NOT NULL,
  PRIMARY KEY (parameter, start_us)
) WITHOUT ROWID;
CREATE TABLE channel (
  id   INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE
);
CREATE TABLE channel_summary (
  channel  INTEGER NOT NULL REFERENCES channel,
  period_s INTEGER NOT NULL,
  start_us INTEGER NOT NULL,
  received INTEGER NOT NULL,
  lost     INTEGER NOT NULL,
  late     INTEGER NOT NULL,
  repaired INTEGER NOT NULL,
  rejected INTEGER NOT NULL,
  stuck    INTEGER NOT NULL,
  clipped  INTEGER NOT NULL,
  noise    REAL,
  PRIMARY KEY (channel, period_s, start_us)
) WITHOUT ROWID;
CREATE TABLE event (
  kind      TEXT NOT NULL,
  id        INTEGER NOT NULL,
  time_us   INTEGER NOT NULL,
  state     INTEGER NOT NULL,
  since_us  INTEGER NOT NULL,
  severity  INTEGER NOT NULL,
  place     TEXT NOT NULL,
  value     REAL,
  std_error REAL,
  unit      TEXT NOT NULL,
  message   TEXT NOT NULL,
  segment   TEXT NOT NULL,
  PRIMARY KEY (kind, id, time_us, state)
) WITHOUT ROWID;
CREATE INDEX event_time ON event (time_us);
)sql",
    R"sql(
CREATE TABLE acknowledgement (
  kind    TEXT NOT NULL,
  id      INTEGER NOT NULL,
  time_us INTEGER NOT NULL,
  place   TEXT NOT NULL,
  who     TEXT NOT NULL,
  comment TEXT NOT NULL,
  PRIMARY KEY (kind, id, time_us)
) WITHOUT ROWID;
)sql",
    R"sql(
CREATE TABLE covariate (
  id   INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE
);
CREATE TABLE weather (
  covariate INTEGER NOT NULL REFERENCES covariate,
  start_us  INTEGER NOT NULL,
  readings  INTEGER NOT NULL,
  mean      REAL NOT NULL,
  min       REAL NOT NULL,
  max       REAL NOT NULL,
  last_us   INTEGER NOT NULL,
  PRIMARY KEY (covariate, start_us)
) WITHOUT ROWID;
)sql",
};
constexpr std::int64_t kOldestRead = 2;  // SummaryQuery::weather() knows that its tables may miss

std::int64_t version_of(SqliteFile& file) {
  SqliteStatement version = file.prepare("PRAGMA user_version");
  return version.row() ? version.integer(0) : -1;
}

/// Returns the SQL of every part of a database by its kind and name, such as "table event". Leaves
/// out the tables of ANALYZE.
std::map<std::string, std::string> parts_of(SqliteFile& file) {
  SqliteStatement all = file.prepare(
      "SELECT type || ' ' || name, sql FROM sqlite_master WHERE sql IS NOT NULL"
      " AND NOT (type = 'table' AND name IN ('sqlite_stat1', 'sqlite_stat4'))");
  std::map<std::string, std::string> out;
  while (all.row()) out[all.text(0)] = all.text(1);
  return out;
}

/// Returns an empty string if the database has the parts that `steps` make. Otherwise names the
/// first part that differs, and condemns the file.
std::string foreign_part(SqliteFile& file, std::span<const char* const> steps) {
  SqliteFile ours;
  if (!ours.open(":memory:")) return ours.error();
  for (const char* step : steps)
    if (!ours.execute(step)) return ours.error();
  const std::map<std::string, std::string> wanted = parts_of(ours), found = parts_of(file);
  if (file.failed()) return file.error();
  std::string out;
  for (const auto& [name, sql] : found)
    if (const auto at = wanted.find(name); out.empty() && (at == wanted.end() || at->second != sql))
      out = at == wanted.end() ? name + " does not belong there" : name + " is not framewatch's";
  for (const auto& [name, sql] : wanted)
    if (out.empty() && !found.contains(name)) out = name + " is missing";
  if (!out.empty()) file.condemn();
  return out.empty() ? "" : "it is another program's: " + out;
}

}  // namespace

std::span<const char* const> history_schema() {
  return kSteps;
}

std::string upgrade(SqliteFile& file, std::span<const char* const> steps) {
  const std::int64_t version = version_of(file);
  const auto wanted = static_cast<std::int64_t>(steps.size());
  if (version < 0 || version > wanted) return version_problem(file, steps);
  const auto known = steps.first(static_cast<std::size_t>(version));
  if (std::string foreign = foreign_part(file, known); !foreign.empty()) return foreign;
  for (std::int64_t v = version; v < wanted; ++v) {
    const bool done = file.transaction([&] {
      return file.execute(steps[static_cast<std::size_t>(v)]) &&
             file.execute(fmt::format("PRAGMA user_version = {}", v + 1));
    });
    if (!done) return fmt::format("cannot upgrade to schema {}: {}", v + 1, file.error());
  }
  return {};
}

std::string version_problem(SqliteFile& file, std::span<const char* const> steps) {
  const std::int64_t version = version_of(file);
  const auto wanted = static_cast<std::int64_t>(steps.size());
  if (version == wanted) return foreign_part(file, steps);
  if (version < 0) return file.error();
  if (version > wanted)
    return fmt::format("a newer framewatch wrote it (schema {}, this one knows {})", version,
                       wanted);
  return fmt::format("has schema {}, not {}: start `framewatch run` to upgrade it", version,
                     wanted);
}

std::string history_read_problem(SqliteFile& file) {
  const std::int64_t version = version_of(file);
  const std::span<const char* const> steps = history_schema();
  if (version < kOldestRead || version >= static_cast<std::int64_t>(steps.size()))
    return version_problem(file, steps);
  return foreign_part(file, steps.first(static_cast<std::size_t>(version)));
}

}  // namespace framewatch::daemon
