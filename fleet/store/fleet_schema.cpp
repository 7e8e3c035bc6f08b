// SPDX-License-Identifier: MIT
#include "fleet/store/fleet_schema.h"

#include <chrono>

#include <fmt/core.h>

#include "drivers/files/number_text.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kSteps[] = {
    R"sql(
CREATE TABLE building (
  id       serial PRIMARY KEY,
  name     text NOT NULL UNIQUE,
  title    text NOT NULL DEFAULT '',
  place    text NOT NULL DEFAULT '',
  latitude double precision,
  longitude double precision,
  first_seen timestamptz NOT NULL DEFAULT now()
);
CREATE TABLE event (
  building  int NOT NULL REFERENCES building,
  kind      text NOT NULL,
  id        bigint NOT NULL,
  time_us   bigint NOT NULL,
  state     int NOT NULL,
  since_us  bigint NOT NULL,
  severity  int NOT NULL,
  place     text NOT NULL,
  value     double precision NOT NULL,
  std_error double precision NOT NULL,
  unit      text NOT NULL,
  message   text NOT NULL,
  segment   text NOT NULL,
  PRIMARY KEY (building, kind, id, time_us, state)
);
CREATE INDEX event_time ON event (time_us);
CREATE TABLE parameters (
  building int NOT NULL REFERENCES building,
  config   bytea NOT NULL,
  name     text[] NOT NULL,
  unit     text[] NOT NULL,
  kind     int[] NOT NULL,
  story    int[] NOT NULL,
  PRIMARY KEY (building, config)
);
CREATE TABLE summary (
  building  int NOT NULL,
  period_s  int NOT NULL,
  start_us  bigint NOT NULL,
  windows   int NOT NULL,
  config    bytea NOT NULL,
  n         int[] NOT NULL,
  median    real[] NOT NULL,
  q1        real[] NOT NULL,
  q3        real[] NOT NULL,
  std_error real[] NOT NULL,
  PRIMARY KEY (building, period_s, start_us)
) PARTITION BY RANGE (start_us);
CREATE TABLE newest (
  building int NOT NULL REFERENCES building,
  kind     text NOT NULL,
  type     text NOT NULL,
  came     timestamptz NOT NULL DEFAULT now(),
  content  bytea NOT NULL,
  PRIMARY KEY (building, kind)
);
CREATE TABLE raw_piece (
  building int NOT NULL REFERENCES building,
  request  text NOT NULL,
  piece    int NOT NULL,
  pieces   int NOT NULL,
  file     text NOT NULL,
  content  bytea NOT NULL,
  came     timestamptz NOT NULL DEFAULT now(),
  PRIMARY KEY (building, request, piece)
);
CREATE TABLE refused (
  id      bigserial PRIMARY KEY,
  came    timestamptz NOT NULL DEFAULT now(),
  subject text NOT NULL,
  key     text NOT NULL,
  reason  text NOT NULL,
  content bytea NOT NULL
);
CREATE TABLE unknown (
  key     text PRIMARY KEY,
  came    timestamptz NOT NULL DEFAULT now(),
  subject text NOT NULL,
  type    text NOT NULL,
  version text NOT NULL,
  content bytea NOT NULL
);
CREATE TABLE flooding (
  building int NOT NULL REFERENCES building,
  hour     timestamptz NOT NULL,
  messages bigint NOT NULL,
  bytes    bigint NOT NULL,
  PRIMARY KEY (building, hour)
);
)sql",
    // Arrival of events, to find those newer than a heartbeat; commands and answers.
    R"sql(
ALTER TABLE building ADD COLUMN retired boolean NOT NULL DEFAULT false,
  ADD COLUMN network text NOT NULL DEFAULT 'XX', ADD COLUMN station text,
  ADD UNIQUE (network, station);
ALTER TABLE event ADD COLUMN came timestamptz NOT NULL DEFAULT now();
CREATE INDEX event_came ON event (building, came);
CREATE INDEX event_shaken ON event (time_us)
  WHERE state = 1 AND kind IN ('strong_motion', 'stiffness_change');
CREATE TABLE journal (
  request text PRIMARY KEY,
  came    timestamptz NOT NULL DEFAULT now(),
  who     text NOT NULL,
  verb    text NOT NULL,
  content text NOT NULL
);
CREATE INDEX journal_came ON journal (came);
CREATE TABLE journal_answer (
  request  text NOT NULL REFERENCES journal,
  building int NOT NULL REFERENCES building,
  came     timestamptz,
  done     boolean,
  answer   text NOT NULL DEFAULT '',
  PRIMARY KEY (request, building)
);
CREATE INDEX journal_answer_building ON journal_answer (building);
)sql",
};

constexpr const char* kOneAtATime = "SELECT pg_advisory_xact_lock(791403826)";

}  // namespace

std::span<const char* const> fleet_schema() {
  return kSteps;
}

std::string upgrade(Database& database) {
  std::string problem;
  const bool done = database.transaction([&] {
    if (!database.execute(kOneAtATime) ||
        !database.execute("CREATE TABLE IF NOT EXISTS schema_version (version int NOT NULL)"))
      return false;
    const auto rows = database.query("SELECT coalesce(max(version), 0) FROM schema_version");
    if (!rows || rows->empty()) return false;
    const auto version = drivers::parse_integer(rows->front().front().value_or("")).value_or(-1);
    const auto wanted = static_cast<std::int64_t>(fleet_schema().size());
    if (version < 0 || version > wanted) {
      problem = fmt::format("a newer framewatch made its tables (version {}, this one knows {})",
                            version, wanted);
      return false;
    }
    for (std::int64_t v = version; v < wanted; ++v)
      if (!database.execute(fleet_schema()[static_cast<std::size_t>(v)]) ||
          !database.execute(fmt::format("DELETE FROM schema_version;"
                                        "INSERT INTO schema_version VALUES ({})",
                                        v + 1)))
        return false;
    return true;
  });
  if (done) return {};
  return problem.empty() ? database.error() : problem;
}

Month month_of(std::int64_t time_us) {
  using namespace std::chrono;
  const sys_time<microseconds> time{microseconds(time_us)};
  const year_month_day date(floor<days>(time));
  const sys_days from(date.year() / date.month() / 1);
  const sys_days to(year_month_day(date.year() / date.month() / 1) + months(1));
  const auto us = [](sys_days day) {
    return duration_cast<microseconds>(day.time_since_epoch()).count();
  };
  return {fmt::format("summary_{:04}_{:02}", static_cast<int>(date.year()),
                      static_cast<unsigned>(date.month())),
          us(from), us(to)};
}

}  // namespace framewatch::fleet
