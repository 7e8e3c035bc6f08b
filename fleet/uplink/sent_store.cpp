// SPDX-License-Identifier: MIT
#include "fleet/uplink/sent_store.h"

#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include <fmt/core.h>

#include "daemon/base/log.h"
#include "daemon/base/sqlite_file.h"
#include "daemon/monitor/history/history_schema.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kSteps[] = {R"sql(
CREATE TABLE sent_event (
  kind            TEXT NOT NULL,
  id              INTEGER NOT NULL,
  time_us         INTEGER NOT NULL,
  state           INTEGER NOT NULL,
  acknowledged_us INTEGER NOT NULL,
  PRIMARY KEY (kind, id, time_us, state)
) WITHOUT ROWID;
CREATE TABLE sent_period (
  period_s        INTEGER NOT NULL,
  start_us        INTEGER NOT NULL,
  windows         INTEGER NOT NULL,
  acknowledged_us INTEGER NOT NULL,
  PRIMARY KEY (period_s, start_us)
) WITHOUT ROWID;
CREATE INDEX sent_event_when ON sent_event (acknowledged_us);
CREATE INDEX sent_period_when ON sent_period (acknowledged_us);
CREATE TABLE wanted (
  from_us INTEGER NOT NULL,
  to_us   INTEGER NOT NULL,
  PRIMARY KEY (from_us, to_us)
) WITHOUT ROWID;
CREATE TABLE journal (
  number  INTEGER PRIMARY KEY,
  request TEXT NOT NULL UNIQUE,
  time_us INTEGER NOT NULL,
  verb    TEXT NOT NULL,
  who     TEXT NOT NULL,
  outcome TEXT NOT NULL
);
CREATE TABLE raw (
  number     INTEGER PRIMARY KEY,
  request    TEXT NOT NULL UNIQUE,
  from_us    INTEGER NOT NULL,
  to_us      INTEGER NOT NULL,
  channels   TEXT NOT NULL,
  most_bytes INTEGER NOT NULL
);
CREATE TABLE sent_piece (
  request TEXT NOT NULL,
  piece   INTEGER NOT NULL,
  PRIMARY KEY (request, piece)
) WITHOUT ROWID;
)sql"};

constexpr const char* kFile = "uplink.sqlite";

}  // namespace

std::string SentStore::open(const std::string& directory, std::int64_t now_us) {
  const std::string path = (std::filesystem::path(directory) / kFile).string();
  for (bool again = false;; again = true) {
    std::string problem;
    if (!file_.open(path)) problem = file_.error();
    if (problem.empty()) problem = daemon::upgrade(file_, kSteps);
    if (problem.empty()) {
      daemon::SqliteStatement sound = file_.prepare("PRAGMA quick_check(1)");
      if (!sound.row())
        problem = file_.error();
      else if (sound.text(0) != "ok")
        problem = "damaged";
    }
    if (problem.empty()) return {};
    const bool damaged = file_.corrupt() || problem == "damaged";
    file_.close();
    if (!damaged || again) return fmt::format("{}: {}", path, problem);
    daemon::SetAside aside;
    daemon::set_aside_database(path, now_us, problem, aside);
    if (!aside.problem.empty()) return aside.problem;
    daemon::log(daemon::LogLevel::error,
                fmt::format("{} is corrupt ({}): it is now {}; everything is sent to the hub again",
                            path, problem, aside.path));
  }
}

bool SentStore::acknowledged(const std::vector<SentEvent>& events,
                             const std::vector<SentPeriod>& periods, std::int64_t clock_us) {
  return file_.transaction([&] {
    daemon::SqliteStatement event = file_.prepare(
        "INSERT INTO sent_event (kind, id, time_us, state, acknowledged_us) VALUES (?1, ?2, ?3, "
        "?4, ?5)"
        " ON CONFLICT DO UPDATE SET acknowledged_us = iif(?6, abs(acknowledged_us), ?5)");
    for (const auto& [k, before] : events) {
      event.bind(1, k.kind).bind(2, k.id).bind(3, k.time_us).bind(4, std::int64_t{k.state});
      if (!event.bind(5, clock_us).bind(6, std::int64_t{before}).run()) return false;
    }
    daemon::SqliteStatement period = file_.prepare(
        "INSERT INTO sent_period (period_s, start_us, windows, acknowledged_us) VALUES (?1, ?2, "
        "?3, ?4)"
        " ON CONFLICT DO UPDATE SET windows = ?3,"
        " acknowledged_us = iif(?5, abs(acknowledged_us), ?4)");
    for (const auto& [k, windows, before] : periods) {
      period.bind(1, k.period_s).bind(2, k.start_us).bind(3, windows).bind(4, clock_us);
      if (!period.bind(5, std::int64_t{before}).run()) return false;
    }
    return true;
  });
}

std::optional<std::int64_t> SentStore::newest_us() {
  daemon::SqliteStatement s = file_.prepare(
      "SELECT max(at) FROM (SELECT max(max(acknowledged_us), -min(acknowledged_us)) AS at"
      " FROM sent_event UNION ALL"
      " SELECT max(max(acknowledged_us), -min(acknowledged_us)) FROM sent_period)");
  if (!s.row() || s.null(0)) return std::nullopt;
  return s.integer(0);
}

bool SentStore::forget_newest(std::int64_t span_us) {
  const std::optional<std::int64_t> newest = newest_us();
  if (!newest) return true;
  return file_.transaction([&] {
    // A negative time means: not known to be acknowledged.
    for (const char* sql :
         {"UPDATE sent_event SET acknowledged_us = -acknowledged_us WHERE acknowledged_us > ?",
          "UPDATE sent_period SET acknowledged_us = -acknowledged_us WHERE acknowledged_us > ?"}) {
      daemon::SqliteStatement s = file_.prepare(sql);
      if (!s.bind(1, std::max<std::int64_t>(*newest - span_us, 0)).run()) return false;
    }
    return true;
  });
}

bool SentStore::forget_between(const TimeRange& time) {
  return file_.transaction([&] {
    for (const char* sql : {"DELETE FROM sent_event WHERE time_us >= ? AND time_us < ?",
                            "DELETE FROM sent_period WHERE start_us >= ? AND start_us < ?"}) {
      daemon::SqliteStatement s = file_.prepare(sql);
      if (!s.bind(1, time.from_us).bind(2, time.to_us).run()) return false;
    }
    return true;
  });
}

bool SentStore::want_minutes(const TimeRange& time) {
  return file_.transaction([&] {
    daemon::SqliteStatement put =
        file_.prepare("INSERT OR IGNORE INTO wanted (from_us, to_us) VALUES (?, ?)");
    if (!put.bind(1, time.from_us).bind(2, time.to_us).run()) return false;
    daemon::SqliteStatement bound = file_.prepare(
        "DELETE FROM wanted WHERE (from_us, to_us) NOT IN"
        " (SELECT from_us, to_us FROM wanted ORDER BY from_us DESC LIMIT ?)");
    return bound.bind(1, kMaxRanges).run();
  });
}

std::vector<TimeRange> SentStore::wanted_minutes() {
  daemon::SqliteStatement s = file_.prepare("SELECT from_us, to_us FROM wanted ORDER BY from_us");
  std::vector<TimeRange> out;
  while (s.row()) out.push_back({s.integer(0), s.integer(1)});
  return out;
}

bool SentStore::note(const JournalEntry& entry) {
  return !journal(entry.request) && file_.transaction([&] {
    daemon::SqliteStatement put = file_.prepare(
        "INSERT INTO journal (request, time_us, verb, who, outcome) VALUES (?, ?, ?, ?, ?)");
    put.bind(1, entry.request).bind(2, entry.time_us).bind(3, entry.verb).bind(4, entry.who);
    if (!put.bind(5, entry.outcome).run()) return false;
    daemon::SqliteStatement bound =
        file_.prepare("DELETE FROM journal WHERE number <= (SELECT max(number) FROM journal) - ?");
    return bound.bind(1, kMaxJournal).run();
  });
}

bool SentStore::conclude(const std::string& request, const std::string& outcome) {
  return file_.transaction([&] {
    daemon::SqliteStatement s = file_.prepare("UPDATE journal SET outcome = ? WHERE request = ?");
    return s.bind(1, outcome).bind(2, request).run();
  });
}

std::optional<JournalEntry> SentStore::journal(const std::string& request) {
  daemon::SqliteStatement s =
      file_.prepare("SELECT verb, who, time_us, outcome FROM journal WHERE request = ?");
  s.bind(1, request);
  if (!s.row()) return std::nullopt;
  return JournalEntry{request, s.text(0), s.text(1), s.integer(2), s.text(3)};
}

bool SentStore::add_raw(const RawRequest& request) {
  return file_.transaction([&] {
    daemon::SqliteStatement put = file_.prepare(
        "INSERT OR IGNORE INTO raw (request, from_us, to_us, channels, most_bytes)"
        " VALUES (?, ?, ?, ?, ?)");
    const std::string channels = nlohmann::json(request.channels)
                                     .dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    put.bind(1, request.request).bind(2, request.time.from_us).bind(3, request.time.to_us);
    return put.bind(4, channels).bind(5, request.most_bytes).run();
  });
}

std::vector<RawRequest> SentStore::raw_requests() {
  daemon::SqliteStatement s = file_.prepare(
      "SELECT request, from_us, to_us, channels, most_bytes FROM raw ORDER BY number");
  std::vector<RawRequest> out;
  while (s.row()) {
    RawRequest r{s.text(0), {s.integer(1), s.integer(2)}, {}, s.integer(4)};
    const auto channels = nlohmann::json::parse(s.text(3), nullptr, false);
    for (const auto& name : channels)
      if (name.is_string()) r.channels.push_back(name.get<std::string>());
    out.push_back(std::move(r));
  }
  return out;
}

bool SentStore::piece_acknowledged(const std::string& request, std::int64_t piece) {
  return file_.transaction([&] {
    daemon::SqliteStatement put =
        file_.prepare("INSERT OR IGNORE INTO sent_piece (request, piece) VALUES (?, ?)");
    return put.bind(1, request).bind(2, piece).run();
  });
}

std::vector<std::int64_t> SentStore::pieces_acknowledged(const std::string& request) {
  daemon::SqliteStatement s =
      file_.prepare("SELECT piece FROM sent_piece WHERE request = ? ORDER BY piece");
  s.bind(1, request);
  std::vector<std::int64_t> out;
  while (s.row()) out.push_back(s.integer(0));
  return out;
}

bool SentStore::raw_is_done(const std::string& request) {
  return file_.transaction([&] {
    for (const char* sql :
         {"DELETE FROM raw WHERE request = ?", "DELETE FROM sent_piece WHERE request = ?"}) {
      daemon::SqliteStatement s = file_.prepare(sql);
      if (!s.bind(1, request).run()) return false;
    }
    return true;
  });
}

}  // namespace framewatch::fleet
