// SPDX-License-Identifier: MIT
#include "fleet/store/fleet_store.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/core.h>

#include "daemon/base/printable.h"
#include "drivers/files/number_text.h"
#include "fleet/store/fleet_schema.h"

namespace framewatch::fleet {
namespace {

using Rows = std::vector<std::vector<SqlValue>>;

constexpr const char* kPutEvent =
    "INSERT INTO event (building, kind, id, time_us, state, since_us, severity, place, value,"
    " std_error, unit, message, segment)"
    " VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13) ON CONFLICT DO NOTHING";
// Buildings send a period again if it grew after it was first sent.
constexpr const char* kPutSummary =
    "INSERT INTO summary (building, period_s, start_us, windows, config, n, median, q1, q3,"
    " std_error) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10)"
    " ON CONFLICT (building, period_s, start_us) DO UPDATE SET windows = excluded.windows,"
    " config = excluded.config, n = excluded.n, median = excluded.median, q1 = excluded.q1,"
    " q3 = excluded.q3, std_error = excluded.std_error WHERE excluded.windows > summary.windows";
constexpr const char* kPutNewest =
    "INSERT INTO newest (building, kind, type, content) VALUES ($1, $2, $3, $4)"
    " ON CONFLICT (building, kind) DO UPDATE SET type = excluded.type, came = now(),"
    " content = excluded.content";
constexpr const char* kPutParameters =
    "INSERT INTO parameters (building, config, name, unit, kind, story)"
    " VALUES ($1, $2, $3, $4, $5, $6) ON CONFLICT DO NOTHING";
constexpr const char* kPutPiece =
    "INSERT INTO raw_piece (building, request, piece, pieces, file, content)"
    " VALUES ($1, $2, $3, $4, $5, $6) ON CONFLICT DO NOTHING";
constexpr const char* kPutRefused =
    "INSERT INTO refused (subject, key, reason, content) VALUES ($1, $2, $3, $4)";
constexpr const char* kPutUnknown =
    "INSERT INTO unknown (key, subject, type, version, content) VALUES ($1, $2, $3, $4, $5)"
    " ON CONFLICT DO NOTHING";
constexpr const char* kPutFlood =
    "INSERT INTO flooding (building, hour, messages, bytes)"
    " VALUES ($1, to_timestamp($2::bigint / 1000000), $3, $4) ON CONFLICT (building, hour)"
    " DO UPDATE SET messages = flooding.messages + excluded.messages,"
    " bytes = flooding.bytes + excluded.bytes";

/// Returns text that PostgreSQL accepts: UTF-8 without NUL. Other bytes become question marks.
std::string text_of(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t bytes = text.front() == '\0' ? 0 : daemon::first_character(text).bytes;
    bytes == 0 ? out += '?' : out += text.substr(0, bytes);
    text.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  return out;
}

std::vector<std::string> texts_of(const std::vector<std::string>& texts) {
  std::vector<std::string> out;
  for (const std::string& text : texts) out.push_back(text_of(text));
  return out;
}

std::string sql_number(double value) {
  return std::isnan(value) ? "NaN" : fmt::format("{}", value);
}

std::string digest_bytes(const std::string& hexadecimal) {
  return "\\x" + hexadecimal;
}

std::vector<SqlValue> event_row(const std::string& id, const event_t& e) {
  return {id,
          text_of(e.kind),
          std::to_string(e.id),
          std::to_string(e.time_us),
          std::to_string(e.state),
          std::to_string(e.since_us),
          std::to_string(e.severity),
          text_of(e.place),
          sql_number(e.value),
          sql_number(e.std_error),
          text_of(e.unit),
          text_of(e.message),
          text_of(e.segment)};
}

std::vector<SqlValue> summary_row(const std::string& id, const summary_t& s) {
  return {id,
          std::to_string(s.period_s),
          std::to_string(s.start_us),
          std::to_string(s.windows),
          digest_bytes(s.config_sha256),
          sql_array(std::span<const std::int32_t>(s.observable)),
          sql_array(std::span<const float>(s.median)),
          sql_array(std::span<const float>(s.q1)),
          sql_array(std::span<const float>(s.q3)),
          sql_array(std::span<const float>(s.std_error))};
}

}  // namespace

std::string FleetStore::open(const std::string& where) {
  if (database_.is_open() && upgraded_) return {};
  close();
  if (!database_.open(where)) return database_.error();
  if (std::string problem = upgrade(database_); !problem.empty()) {
    close();
    return problem;
  }
  upgraded_ = true;
  return {};
}

void FleetStore::close() {
  database_.close();
  upgraded_ = false;
  ids_.clear();
  months_.clear();
}

std::string FleetStore::id_of(const std::string& building) const {
  return ids_.at(building);
}

std::string FleetStore::add(const FleetBatch& batch) {
  of_values_ = false;
  // Adds buildings and months first, each separately, so that the batch never waits for another
  // worker's new building.
  if (add_buildings(batch) && add_months(batch) &&
      database_.transaction([&] { return add_all(batch); }))
    return {};
  std::string why = database_.error();
  of_values_ = database_.is_of_values();
  close();  // the cached ids may be outdated
  return why;
}

std::optional<DayCounts> FleetStore::counts(const std::string& building, std::int64_t from_us,
                                            std::int64_t to_us) {
  const std::vector<SqlValue> which{building, std::to_string(from_us), std::to_string(to_us)};
  const auto number = [](const SqlValue& value) {
    return drivers::parse_integer(value.value_or("")).value_or(0);
  };
  const auto events = database_.query(
      "SELECT count(*) FROM event JOIN building b ON b.id = building"
      " WHERE b.name = $1 AND time_us >= $2 AND time_us < $3",
      which);
  if (!events || events->empty()) return std::nullopt;
  const auto periods = database_.query(
      "SELECT period_s, count(*) FROM summary JOIN building b ON b.id = building"
      " WHERE b.name = $1 AND start_us >= $2 AND start_us < $3 GROUP BY period_s",
      which);
  if (!periods) return std::nullopt;
  DayCounts out{number(events->front().front()), {}};
  for (const auto& row : *periods) out.periods[number(row[0])] = number(row[1]);
  return out;
}

std::optional<std::string> FleetStore::newest_text(const std::string& building,
                                                   const std::string& kind) {
  const auto rows = database_.query(
      "SELECT convert_from(content, 'UTF8') FROM newest JOIN building b ON b.id = building"
      " WHERE b.name = $1 AND newest.kind = $2",
      {building, kind});
  if (!rows) return std::nullopt;
  return rows->empty() ? "" : rows->front().front().value_or("");
}

bool FleetStore::add_buildings(const FleetBatch& batch) {
  std::set<std::string> names;
  const auto note = [&](const auto& list) {
    for (const auto& one : list)
      if (!ids_.contains(one.building)) names.insert(one.building);
  };
  note(batch.events);
  note(batch.summaries);
  note(batch.newest);
  note(batch.parameters);
  note(batch.pieces);
  note(batch.floods);
  for (const std::string& name : names) {
    if (!database_.run("INSERT INTO building (name) VALUES ($1) ON CONFLICT DO NOTHING", {name}))
      return false;
    const auto rows = database_.query("SELECT id FROM building WHERE name = $1", {name});
    if (!rows || rows->empty()) return false;
    ids_[name] = rows->front().front().value_or("");
  }
  return true;
}

/// Keeps the arrays of up to 300 parameters inside the row: floats do not compress, and each array
/// outside costs a lookup on reading.
bool FleetStore::add_months(const FleetBatch& batch) {
  for (const ReceivedSummary& received : batch.summaries) {
    const Month month = month_of(received.summary.start_us);
    if (months_.contains(month.table)) continue;
    const bool made = database_.transaction([&] {
      return database_.execute("SELECT pg_advisory_xact_lock(791403827)") &&
             database_.execute(fmt::format("CREATE TABLE IF NOT EXISTS {} PARTITION OF summary"
                                           " FOR VALUES FROM ({}) TO ({})"
                                           " WITH (toast_tuple_target = 8160)",
                                           month.table, month.from_us, month.to_us));
    });
    if (!made) return false;
    months_.insert(month.table);
  }
  return true;
}

bool FleetStore::add_all(const FleetBatch& batch) {
  Rows events, summaries, newest, parameters, pieces, refused, unknown, floods;
  for (const ReceivedEvent& e : batch.events)
    events.push_back(event_row(id_of(e.building), e.event));
  for (const ReceivedSummary& s : batch.summaries)
    summaries.push_back(summary_row(id_of(s.building), s.summary));
  for (const ReceivedNewest& n : batch.newest)
    newest.push_back({id_of(n.building), n.kind, n.type, sql_bytes(n.content)});
  for (const ReceivedParameters& p : batch.parameters)
    parameters.push_back({id_of(p.building), digest_bytes(p.table.config_sha256),
                          sql_array(texts_of(p.table.name)), sql_array(texts_of(p.table.unit)),
                          sql_array(std::span<const std::int32_t>(p.table.kind)),
                          sql_array(std::span<const std::int32_t>(p.table.story))});
  for (const ReceivedPiece& p : batch.pieces)
    pieces.push_back({id_of(p.building), p.request, std::to_string(p.piece),
                      std::to_string(p.pieces), text_of(p.file), sql_bytes(p.content)});
  for (const ReceivedOther& o : batch.others)
    if (o.reason.empty())
      unknown.push_back({text_of(o.key), text_of(o.subject), text_of(o.type), text_of(o.version),
                         sql_bytes(o.content)});
    else
      refused.push_back({text_of(o.subject), text_of(o.key), o.reason, sql_bytes(o.content)});
  for (const ReceivedFlood& f : batch.floods)
    floods.push_back({id_of(f.building), std::to_string(f.hour_us), std::to_string(f.messages),
                      std::to_string(f.bytes)});
  return database_.run_each(kPutEvent, events) && database_.run_each(kPutSummary, summaries) &&
         database_.run_each(kPutNewest, newest) && database_.run_each(kPutParameters, parameters) &&
         database_.run_each(kPutPiece, pieces) && database_.run_each(kPutRefused, refused) &&
         database_.run_each(kPutUnknown, unknown) && database_.run_each(kPutFlood, floods);
}

}  // namespace framewatch::fleet
