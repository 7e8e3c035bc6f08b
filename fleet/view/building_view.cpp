// SPDX-License-Identifier: MIT
#include "fleet/view/building_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <framewatch/parameter_table_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/watch_t.hpp>

#include "daemon/base/clocks.h"
#include "drivers/lcm/message_check.h"
#include "estimator/numeric/quantile.h"
#include "fleet/view/overview.h"
#include "fleet/view/rows.h"

namespace framewatch::fleet {
namespace {

using daemon::kDay_us;
using nlohmann::json;

constexpr const char* kNewest =
    "SELECT kind, content FROM newest WHERE building = (SELECT id FROM building WHERE name = $1)";
constexpr const char* kNewestEvents =
    "SELECT time_us, since_us, id, state, severity, kind, place, value, std_error, unit, message"
    " FROM event WHERE building = (SELECT id FROM building WHERE name = $1)"
    " ORDER BY time_us DESC LIMIT 200";
// The last day, newest first. Only the constant limit makes PostgreSQL skip partitions.
constexpr const char* kDayOfPeriods =
    "SELECT start_us, period_s, config, n, median, std_error FROM summary"
    " WHERE building = (SELECT id FROM building WHERE name = $1) AND period_s IN (60, 600)"
    " AND start_us > $2 AND start_us <= $2 + 86400000000 ORDER BY start_us DESC LIMIT 300";
constexpr const char* kNewestPeriod =
    "SELECT max(m) FROM unnest(ARRAY[60, 600]) p, LATERAL (SELECT max(start_us) AS m FROM summary"
    " WHERE building = (SELECT id FROM building WHERE name = $1) AND period_s = p) o";
constexpr const char* kStretches =
    "SELECT request, count(*), max(pieces), sum(octet_length(content)), min(file), {},"
    " min(CASE WHEN pieces = 0 THEN encode(content, 'escape') END)"
    " FROM raw_piece WHERE building = (SELECT id FROM building WHERE name = $1)"
    " GROUP BY request ORDER BY max(came) DESC LIMIT 50";

/// The newest messages of a building; nullopt where missing or unreadable.
struct NewestOf {
  std::optional<service_t> service;
  std::optional<status_t> status;
  std::optional<watch_t> watch;
  std::optional<parameter_table_t> table;

  explicit NewestOf(const Rows& rows) {
    for (const Database::Row& row : rows) {
      const std::string kind = text_at(row, 0);
      const Bytes content = bytes_at(row, 1);
      if (kind == "service") service = drivers::decoded<service_t>(content);
      if (kind == "status") status = drivers::decoded<status_t>(content);
      if (kind == "watch") watch = drivers::decoded<watch_t>(content);
      if (kind == "parameters") table = drivers::decoded<parameter_table_t>(content);
    }
  }
};

std::string hexadecimal(std::string_view bytes) {
  std::string out;
  for (const char c : bytes) out += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return out;
}

json raised_json(const BuildingState& state) {
  json out = json::array();
  for (const event_t& e : state.raised)
    out.push_back({{"id", e.id},
                   {"since_us", e.since_us},
                   {"severity", e.severity},
                   {"kind", e.kind},
                   {"place", e.place},
                   {"message", e.message},
                   {"value", e.value},
                   {"std_error", e.std_error},
                   {"known", state.is_known(e)},
                   {"known_to", state.is_known(e) ? state.known.at(e.id) : ""}});
  return out;
}

json events_json(const Rows& rows) {
  json out = json::array();
  for (const Database::Row& row : rows)
    out.push_back({{"time_us", integer_at(row, 0)},
                   {"since_us", integer_at(row, 1)},
                   {"id", integer_at(row, 2)},
                   {"state", integer_at(row, 3)},
                   {"severity", integer_at(row, 4)},
                   {"kind", text_at(row, 5)},
                   {"place", text_at(row, 6)},
                   {"value", number_at(row, 7).value_or(NAN)},
                   {"std_error", number_at(row, 8).value_or(NAN)},
                   {"unit", text_at(row, 9)},
                   {"message", text_at(row, 10)}});
  return out;
}

/// Returns the parameters, each with the newest period in which it was observable.
json parameters_json(const NewestOf& newest, const Rows& periods) {
  json out = json::array();
  if (!newest.table) return out;
  const parameter_table_t& t = *newest.table;
  const bool watched =
      newest.watch && newest.watch->baseline.size() == static_cast<std::size_t>(t.parameters);
  for (std::size_t i = 0; i < static_cast<std::size_t>(t.parameters); ++i) {
    json one{{"name", t.name[i]},   {"unit", t.unit[i]},     {"kind", t.kind[i]},
             {"story", t.story[i]}, {"design", t.design[i]}, {"baseline", nullptr}};
    if (watched) {
      one["baseline"] = newest.watch->baseline[i];
      one["baseline_std_error"] = newest.watch->baseline_std_error[i];
    }
    out.push_back(std::move(one));
  }
  std::size_t lacking = out.size();
  for (const Database::Row& row : periods) {
    if (lacking == 0) break;
    if (hexadecimal(text_at(row, 2)) != t.config_sha256) continue;
    const auto n = integers_of(text_at(row, 3));
    const auto median = reals_of(text_at(row, 4)), error = reals_of(text_at(row, 5));
    if (n.size() != out.size() || median.size() != n.size() || error.size() != n.size()) continue;
    for (std::size_t i = 0; i < n.size(); ++i) {
      if (n[i] <= 0 || out[i].contains("observed_us")) continue;
      out[i]["observed_us"] = integer_of(text_at(row, 0));
      out[i]["median"] = median[i];
      out[i]["std_error"] = error[i];
      out[i]["windows"] = n[i];
      --lacking;
    }
  }
  return out;
}

json channels_json(const NewestOf& newest) {
  json out = json::array();
  if (!newest.service) return out;
  const service_t& s = *newest.service;
  for (std::size_t i = 0; i < s.name.size(); ++i) {
    json one{{"name", s.name[i]}, {"newest_us", s.newest_us[i]}};
    if (newest.status && newest.status->name.size() == s.name.size())
      for (const auto& [word, counts] : {std::pair{"received", &newest.status->received},
                                         {"lost", &newest.status->lost},
                                         {"late", &newest.status->late},
                                         {"rejected", &newest.status->rejected},
                                         {"stuck", &newest.status->stuck},
                                         {"clipped", &newest.status->clipped}})
        one[word] = (*counts)[i];
    out.push_back(std::move(one));
  }
  return out;
}

json process_json(const service_t& s) {
  return {{"version", s.version},
          {"config_sha256", s.config_sha256},
          {"time_us", s.time_us},
          {"started_us", s.started_us},
          {"unclean_starts", s.unclean_starts},
          {"reload_problem", s.reload_problem},
          {"state_problem", s.state_problem},
          {"disk_free_bytes", s.disk_free_bytes},
          {"resident_bytes", s.resident_bytes},
          {"received_us", s.received_us}};
}

json stretches_json(const Rows& rows) {
  json out = json::array();
  for (const Database::Row& row : rows)
    out.push_back({{"request", text_at(row, 0)},
                   {"came", integer_at(row, 1)},
                   {"pieces", integer_at(row, 2)},
                   {"bytes", integer_at(row, 3)},
                   {"file", text_at(row, 4)},
                   {"newest_us", integer_at(row, 5)},
                   {"problem", text_at(row, 6)}});
  return out;
}

constexpr const char* kPiecesOf =
    " FROM raw_piece WHERE building = (SELECT id FROM building WHERE name = $1) AND request = $2";

using daemon::kSecond_us;
using nlohmann::json;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Point {
  std::int64_t t_us = 0, windows = 0;
  double median = kNone, q1 = kNone, q3 = kNone, std_error = kNone;
};

// The index of a parameter depends on the configuration of the period, so it is looked up once for
// each configuration.
constexpr const char* kPoints =
    "SELECT start_us, n[i], median[i], q1[i], q3[i], std_error[i], unit FROM ("
    " SELECT config AS of, unit[array_position(name, $2)], array_position(name, $2) AS i"
    " FROM parameters WHERE building = (SELECT id FROM building WHERE name = $1) OFFSET 0) p"
    " JOIN summary s ON s.config = p.of"
    " WHERE i IS NOT NULL AND s.building = (SELECT id FROM building WHERE name = $1)"
    " AND s.period_s = $3 AND s.start_us >= $4 AND s.start_us < $5 ORDER BY start_us";
constexpr const char* kLengths =
    "SELECT p FROM unnest(ARRAY[60, 600, 3600]) p WHERE EXISTS (SELECT 1 FROM summary"
    " WHERE building = (SELECT id FROM building WHERE name = $1) AND period_s = p"
    " AND start_us >= $2 AND start_us < $3) ORDER BY p";

/// Returns the finest stored period that gives at most kMaxPoints points; else the longest.
int best_period(Database& database, const SeriesRequest& r) {
  const auto rows =
      database.query(kLengths, {r.building, std::to_string(r.from_us), std::to_string(r.to_us)});
  if (!rows || rows->empty()) return 600;
  for (const Database::Row& row : *rows)
    if ((r.to_us - r.from_us) / (integer_at(row, 0) * kSecond_us) <=
        static_cast<std::int64_t>(SeriesRequest::kMaxPoints))
      return static_cast<int>(integer_at(row, 0));
  return static_cast<int>(integer_at(rows->back(), 0));
}

Point joined(const std::vector<Point>& points, std::size_t from, std::size_t to) {
  Point out{points[from].t_us, 0, kNone, kNone, kNone, kNone};
  std::vector<double> medians;
  double squares = 0;
  for (std::size_t i = from; i < to; ++i) {
    const Point& p = points[i];
    out.windows += p.windows;
    if (std::isnan(p.median)) continue;
    medians.push_back(p.median);
    squares += p.std_error * p.std_error;
    out.q1 = std::isnan(out.q1) ? p.q1 : std::min(out.q1, p.q1);
    out.q3 = std::isnan(out.q3) ? p.q3 : std::max(out.q3, p.q3);
  }
  if (medians.empty()) return out;
  out.median = estimator::upper_median(medians);
  out.std_error = std::sqrt(squares / static_cast<double>(medians.size()));
  return out;
}

}  // namespace

std::string building_json(Database& database, const std::string& name) {
  const Overview overview = read_overview(database, name);
  if (!overview.problem.empty()) return json{{"problem", overview.problem}}.dump();
  if (overview.buildings.empty()) return json{{"problem", "no such building"}}.dump();
  const auto newest = database.query(kNewest, {name});
  const auto events = newest ? database.query(kNewestEvents, {name}) : std::nullopt;
  const auto last = events ? database.query(kNewestPeriod, {name}) : std::nullopt;
  const std::int64_t from_us = last && !last->empty() ? integer_at(last->front(), 0) - kDay_us : 0;
  const auto periods =
      last ? database.query_binary(kDayOfPeriods, {name, std::to_string(from_us)}) : std::nullopt;
  const auto stretches =
      periods ? database.query(fmt::format(kStretches, sql_us("max(came)")), {name}) : std::nullopt;
  if (!stretches) return json{{"problem", database.error()}}.dump();
  const BuildingState& state = overview.buildings.front();
  const Judged verdict = judged(state, overview.now_us);
  const NewestOf messages(*newest);
  json out{{"name", state.name},
           {"title", state.title},
           {"place", state.place},
           {"latitude", nullptr},
           {"longitude", nullptr},
           {"now_us", overview.now_us},
           {"heard_us", state.heard_us ? json(*state.heard_us) : json(nullptr)},
           {"urgency", urgency_word(verdict.urgency)},
           {"since_us", verdict.since_us},
           {"message", verdict.message},
           {"raised", raised_json(state)},
           {"parameters", parameters_json(messages, *periods)},
           {"channels", channels_json(messages)},
           {"events", events_json(*events)},
           {"stretches", stretches_json(*stretches)}};
  if (state.latitude) out["latitude"] = *state.latitude;
  if (state.longitude) out["longitude"] = *state.longitude;
  if (messages.service) out["process"] = process_json(*messages.service);
  if (messages.table) out["structure"] = messages.table->structure;
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::optional<FetchedSamples> read_fetched(Database& database, const std::string& building,
                                           const std::string& request, std::string& why) {
  const auto state = database.query(
      fmt::format("SELECT count(*), max(pieces), min(file){}", kPiecesOf), {building, request});
  const auto pieces =
      state ? database.query_binary(fmt::format("SELECT content{} ORDER BY piece", kPiecesOf),
                                    {building, request})
            : std::nullopt;
  if (!pieces) {
    why = database.error();
    return std::nullopt;
  }
  const std::int64_t come = integer_at(state->front(), 0), all = integer_at(state->front(), 1);
  FetchedSamples out{text_at(state->front(), 2), {}};
  for (const Database::Row& piece : *pieces)
    out.miniseed.insert(out.miniseed.end(), piece[0]->begin(), piece[0]->end());
  if (come == all && come > 0) return out;
  why = come == 0  ? "no piece has come yet"
        : all == 0 ? "no samples: " + std::string(out.miniseed.begin(), out.miniseed.end())
                   : fmt::format("{} of {} pieces have come", come, all);
  return std::nullopt;
}

std::string series_json(Database& database, const SeriesRequest& r) {
  const int period_s = r.period_s > 0 ? r.period_s : best_period(database, r);
  const auto rows = database.query(kPoints, {r.building, r.parameter, std::to_string(period_s),
                                             std::to_string(r.from_us), std::to_string(r.to_us)});
  if (!rows) return json{{"problem", database.error()}}.dump();
  std::vector<Point> points;
  std::string unit;
  for (const Database::Row& row : *rows) {
    Point p{integer_at(row, 0), integer_at(row, 1), kNone, kNone, kNone, kNone};
    if (p.windows > 0) {
      p.median = number_at(row, 2).value_or(kNone);
      p.q1 = number_at(row, 3).value_or(kNone);
      p.q3 = number_at(row, 4).value_or(kNone);
      p.std_error = number_at(row, 5).value_or(kNone);
    }
    unit = text_at(row, 6);
    points.push_back(p);
  }
  const std::size_t of = points.size() / SeriesRequest::kMaxPoints + 1;
  json t = json::array(), windows = t, median = t, q1 = t, q3 = t, error = t;
  for (std::size_t from = 0; from < points.size(); from += of) {
    const Point p =
        of == 1 ? points[from] : joined(points, from, std::min(from + of, points.size()));
    t.push_back(p.t_us);
    windows.push_back(p.windows);
    median.push_back(p.median);
    q1.push_back(p.q1);
    q3.push_back(p.q3);
    error.push_back(p.std_error);
  }
  return json{{"period_s", period_s}, {"of", of},         {"unit", unit}, {"t_us", t},
              {"windows", windows},   {"median", median}, {"q1", q1},     {"q3", q3},
              {"std_error", error}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace framewatch::fleet
