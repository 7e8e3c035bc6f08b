// SPDX-License-Identifier: MIT
#include "fleet/serve/fleet_pages.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/printable.h"
#include "daemon/base/process.h"
#include "drivers/files/number_text.h"
#include "fleet/message/address.h"
#include "fleet/serve/commander.h"
#include "fleet/store/database.h"
#include "fleet/store/fleet_schema.h"
#include "fleet/view/building_view.h"
#include "fleet/view/earthquake_view.h"
#include "fleet/view/overview.h"
#include "fleet/view/rows.h"

namespace framewatch::fleet {
namespace {

using nlohmann::json;

constexpr int kMaxCommands = 200, kMaxAnswers = 50;

constexpr const char* kTargets =
    "SELECT id, name FROM building WHERE CASE WHEN $1 = 'all' THEN NOT retired ELSE name = $1 END"
    " ORDER BY name";
constexpr const char* kPutOrder =
    "INSERT INTO journal (request, who, verb, content) VALUES ($1, $2, $3, $4)";
constexpr const char* kPutTarget = "INSERT INTO journal_answer (request, building) VALUES ($1, $2)";
constexpr const char* kPutResult =
    "UPDATE journal_answer SET came = now(), done = $3, answer = $4 WHERE request = $1 AND "
    "building "
    "= $2";
constexpr const char* kCommands =
    "SELECT j.request, {}, j.who, j.verb, j.content, count(a), count(*) FILTER (WHERE a.done),"
    " count(*) FILTER (WHERE NOT a.done), count(a) - count(a.done)"
    " FROM journal j LEFT JOIN journal_answer a ON a.request = j.request"
    " WHERE $1 = '' OR j.request IN (SELECT o.request FROM journal_answer o JOIN building b"
    " ON b.id = o.building WHERE b.name = $1)"
    " GROUP BY j.request ORDER BY j.came DESC LIMIT {}";
constexpr const char* kAnswers =
    "SELECT request, name, {}, done, answer FROM (SELECT a.*, b.name, row_number() OVER"
    " (PARTITION BY a.request ORDER BY a.done NULLS FIRST, b.name) AS place FROM journal_answer a"
    " JOIN building b ON b.id = a.building WHERE a.request = ANY($1)"
    " AND ($2 = '' OR b.name = $2)) o WHERE place <= {} ORDER BY request, place";

/// Stores a command in the journal and finds its target buildings. building: a name, or "all" for
/// every building that is not retired. Returns false and sets the reason if it could not be stored;
/// then it must not be sent.
bool note_order(Database& database, const std::string& building, CommandOrder& order,
                std::string& why) {
  const auto targets = database.query(kTargets, {building});
  if (!targets || targets->empty()) {
    why = targets ? "no such building" : database.error();
    return false;
  }
  std::vector<Database::Row> rows;
  for (const Database::Row& row : *targets) {
    order.targets.push_back({integer_at(row, 0), text_at(row, 1)});
    rows.push_back({order.request, row[0]});
  }
  const bool noted = database.transaction([&] {
    return database.run(kPutOrder, {order.request, order.who, order.verb, order.content}) &&
           database.run_each(kPutTarget, rows);
  });
  if (!noted) why = "cannot write the journal: " + database.error();
  return noted;
}

/// Stores the result of a command. Returns false if the database fails.
bool note_result(Database& database, const CommandResult& result) {
  return database.run(kPutResult, {result.request, std::to_string(result.building),
                                   result.done ? "true" : "false", result.answer});
}

/// Returns the newest 200 commands of `building` (empty: of all): [{"request", "came_us", "who",
/// "verb", "content": {}, "buildings": n, "done": n, "refused": n, "waiting": n, "answers":
/// [{"building", "came_us", "done", "answer"}]}]. Lists 50 answers, refusals first.
std::string journal_json(Database& database, const std::string& building) {
  const auto commands =
      database.query(fmt::format(kCommands, sql_us("j.came"), kMaxCommands), {building});
  if (!commands) return json{{"problem", database.error()}}.dump();
  std::vector<std::string> requests;
  for (const Database::Row& row : *commands) requests.push_back(text_at(row, 0));
  const auto answers = database.query(fmt::format(kAnswers, sql_us("came"), kMaxAnswers),
                                      {sql_array(requests), building});
  if (!answers) return json{{"problem", database.error()}}.dump();
  json out = json::array();
  for (const Database::Row& row : *commands) {
    json one{{"request", text_at(row, 0)},
             {"came_us", integer_at(row, 1)},
             {"who", text_at(row, 2)},
             {"verb", text_at(row, 3)},
             {"content", json::parse(text_at(row, 4), nullptr, false)},
             {"buildings", integer_at(row, 5)},
             {"done", integer_at(row, 6)},
             {"refused", integer_at(row, 7)},
             {"waiting", integer_at(row, 8)},
             {"answers", json::array()}};
    if (one["content"].is_discarded()) one["content"] = json::object();
    for (const Database::Row& answer : *answers)
      if (answer[0] == row[0])
        one["answers"].push_back(
            {{"building", text_at(answer, 1)},
             {"came_us", answer[2] ? json(integer_at(answer, 2)) : json(nullptr)},
             {"done", answer[3] ? json(text_at(answer, 3) == "t") : json(nullptr)},
             {"answer", text_at(answer, 4)}});
    out.push_back(std::move(one));
  }
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

using nlohmann::json;

constexpr const char* kJson = "application/json";
constexpr std::size_t kVersionDigits = 16, kLongestParameter = 64;
constexpr int kMaxDays = 3660;
constexpr std::int64_t kLatest_us = INT64_MAX / 4;

PageAnswer refuse(unsigned code, const std::string& why) {
  return {code, json{{"problem", why}}.dump(-1, ' ', true, json::error_handler_t::replace), kJson};
}

/// Returns the answer of a view: 503 if the database failed, 404 if nothing was found.
PageAnswer view(std::string text) {
  const unsigned code = text == R"({"problem":"no such building"})" ? 404
                        : text.starts_with(R"({"problem")")         ? 503
                                                                    : 200;
  return {code, std::move(text), kJson};
}

std::optional<std::int64_t> time_of(const PageRequest& r, const std::string& name) {
  const auto value = drivers::parse_integer(r.argument(name));
  if (!value || *value < -kLatest_us || *value > kLatest_us) return std::nullopt;
  return value;
}

bool is_building_or_none(const std::string& name) {
  return name.empty() || is_building_name(name);
}

}  // namespace

DatabasePool::Lent DatabasePool::lend() {
  std::unique_ptr<Database> database;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!free_.empty()) {
      database = std::move(free_.back());
      free_.pop_back();
    }
  }
  if (!database) database = std::make_unique<Database>();
  if (database->is_open() || !database->open(where_)) return {*this, std::move(database)};
  // Several programs may start at once; the tables match this program afterwards.
  if (!upgrade(*database).empty() ||
      !database->execute(fmt::format("SET statement_timeout = '{}'", kLongest)))
    database->close();
  return {*this, std::move(database)};
}

DatabasePool::Lent::~Lent() {
  if (!database_->is_open()) return;  // the next lend() opens a new one
  const std::lock_guard<std::mutex> lock(pool_.mutex_);
  pool_.free_.push_back(std::move(database_));
}

std::string PageRequest::argument(const std::string& name) const {
  const auto found = arguments.find(name);
  return found == arguments.end() ? "" : found->second;
}

FleetPages::FleetPages(std::string database, Give give)
    : pool_(std::move(database)), give_(std::move(give)) {}

PageAnswer FleetPages::answer(const PageRequest& r) {
  if (r.path == "/command") return command(r);
  if (r.path == "/me.json") return me(r);
  if (r.path == "/overview.json") return overview(r);
  if (r.path == "/building.json") return building(r);
  if (r.path == "/series.json") return series(r);
  if (r.path == "/earthquake.json") return earthquake(r);
  if (r.path == "/raw.mseed") return raw(r);
  const auto lent = pool_.lend();
  if (r.path == "/earthquakes.json") {
    const auto days = drivers::parse_integer(r.argument("days"));
    if (!days || *days < 1 || *days > kMaxDays)
      return refuse(400, fmt::format("days must be 1 to {}", kMaxDays));
    return view(earthquakes_json(*lent, static_cast<int>(*days)));
  }
  if (r.path == "/journal.json") {
    if (!is_building_or_none(r.argument("name")))
      return refuse(400, "name must be the name of a building");
    return view(journal_json(*lent, r.argument("name")));
  }
  return refuse(404, "not found");
}

PageAnswer FleetPages::me(const PageRequest& r) const {
  return {200,
          json{{"who", r.who}, {"role", role_word(r.role)}, {"hub", give_ != nullptr}}.dump(
              -1, ' ', true, json::error_handler_t::replace),
          kJson};
}

/// Answers 204 if the viewer has this version. The version excludes values that always change.
PageAnswer FleetPages::overview(const PageRequest& r) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::int64_t now_us = daemon::steady_clock_us();
  if (overview_.empty() || now_us - overview_us_ > kFresh_us) {
    const auto lent = pool_.lend();
    const Overview read = read_overview(*lent);
    if (!read.problem.empty()) return refuse(503, read.problem);
    overview_ = overview_json(read);
    overview_us_ = daemon::steady_clock_us();
    json same = json::parse(overview_);
    same.erase("now_us");
    same.erase("heard_us");
    version_ = daemon::sha256(same.dump()).substr(0, kVersionDigits);
    overview_.insert(1, fmt::format(R"("version":"{}",)", version_));
  }
  if (r.argument("version") == version_) return {204, "", kJson};
  return {200, overview_, kJson};
}

PageAnswer FleetPages::building(const PageRequest& r) {
  if (!is_building_name(r.argument("name")))
    return refuse(400, "name must be the name of a building");
  const auto lent = pool_.lend();
  return view(building_json(*lent, r.argument("name")));
}

PageAnswer FleetPages::series(const PageRequest& r) {
  const auto from = time_of(r, "from_us"), to = time_of(r, "to_us");
  const std::string parameter = r.argument("parameter"), period = r.argument("period_s");
  if (!is_building_name(r.argument("name")))
    return refuse(400, "name must be the name of a building");
  if (parameter.empty() || parameter.size() > kLongestParameter)
    return refuse(400, "parameter must be 1 to 64 characters");
  if (!from || !to || *from >= *to)
    return refuse(400, "from_us and to_us must be times in us since 1970, to_us after from_us");
  if (!period.empty() && period != "60" && period != "600" && period != "3600")
    return refuse(400, "period_s must be 60, 600 or 3600");
  const auto lent = pool_.lend();
  return view(series_json(*lent, {r.argument("name"), parameter, *from, *to,
                                  static_cast<int>(drivers::parse_integer(period).value_or(0))}));
}

PageAnswer FleetPages::earthquake(const PageRequest& r) {
  const auto time = time_of(r, "time_us");
  if (!time) return refuse(400, "time_us must be a time in us since 1970");
  if (!is_building_or_none(r.argument("name")))
    return refuse(400, "name must be the name of a building");
  const auto lent = pool_.lend();
  return view(earthquake_json(*lent, {*time, r.argument("name")}));
}

PageAnswer FleetPages::raw(const PageRequest& r) {
  if (!is_building_name(r.argument("name")))
    return refuse(400, "name must be the name of a building");
  const auto lent = pool_.lend();
  std::string why;
  const auto stretch = read_fetched(*lent, r.argument("name"), r.argument("request"), why);
  if (!stretch) return refuse(why == lent->error() ? 503 : 404, why);
  return {200, {stretch->miniseed.begin(), stretch->miniseed.end()}, "application/octet-stream"};
}

PageAnswer FleetPages::command(const PageRequest& r) {
  const std::string building = r.argument("building");
  CommandOrder order{
      fmt::format("page-{}", daemon::random_id()), r.who, r.argument("verb"), {}, {}};
  if (r.role != Role::operator_) {
    daemon::log(daemon::LogLevel::warning,
                daemon::printable(fmt::format("viewer {} may not give the command {} to {}", r.who,
                                              order.verb.substr(0, 32), building.substr(0, 32))));
    return refuse(403, "only operators may give commands");
  }
  if (!give_) return refuse(409, "this page runs without a hub: start it with --hub");
  if (building != "all" && !is_building_name(building))
    return refuse(400, "building must be the name of a building, or all");
  std::string why;
  const auto content =
      command_content({order.verb, r.argument("from_us"), r.argument("to_us"),
                       r.argument("channels"), r.argument("id"), r.argument("comment")},
                      why);
  if (!content) return refuse(400, why);
  if (building == "all" && (order.verb == "acknowledge" || order.verb == "raw"))
    return refuse(400, order.verb + " is for one building");
  order.content = *content;
  const auto lent = pool_.lend();
  if (!note_order(*lent, building, order, why))
    return refuse(why == "no such building" ? 404 : 503, why);
  const std::string request = order.request;
  const std::size_t buildings = order.targets.size();
  daemon::log(daemon::LogLevel::notice,
              fmt::format("{}: {} to {} buildings, {}", r.who, order.verb, buildings, request));
  std::vector<CommandOrder::Target> targets = order.targets;
  if (!give_(std::move(order))) {
    for (const CommandOrder::Target& target : targets)
      (void)note_result(
          *lent, {request, target.id, false, "too many commands are waiting: try again later"});
    return refuse(503, "too many commands are waiting: try again later");
  }
  return {202, json{{"request", request}, {"buildings", buildings}}.dump(), kJson};
}

void FleetPages::note(const CommandResult& result) {
  const auto lent = pool_.lend();
  if (!note_result(*lent, result))
    failures_(daemon::steady_clock_us(),
              fmt::format("cannot store the answer to {} in the journal: {}", result.request,
                          lent->error()));
}

}  // namespace framewatch::fleet
