#include "fleet/serve/journal.h"

#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

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

}  // namespace

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
  if (!noted) why = "the journal cannot be written: " + database.error();
  return noted;
}

bool note_result(Database& database, const CommandResult& result) {
  return database.run(kPutResult, {result.request, std::to_string(result.building),
                                   result.done ? "true" : "false", result.answer});
}

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

}  // namespace framewatch::fleet
