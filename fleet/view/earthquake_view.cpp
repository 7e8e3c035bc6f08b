// SPDX-License-Identifier: MIT
#include "fleet/view/earthquake_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "fleet/view/comparison.h"
#include "fleet/view/rows.h"

namespace framewatch::fleet {
namespace {

using daemon::kSecond_us;
using nlohmann::json;

constexpr std::int64_t kTogether_us = 60 * kSecond_us;
constexpr std::size_t kMinTogether = 3, kMaxEarthquakes = 50;
constexpr int kMaxEvents = 20'000;

constexpr const char* kComparedBuildings =
    "SELECT id, name, title, place FROM building"
    " WHERE CASE WHEN $1 = '' THEN NOT retired ELSE name = $1 END";
constexpr const char* kShaken =
    "SELECT building, since_us FROM event WHERE state = 1"
    " AND kind IN ('strong_motion', 'stiffness_change')"
    " AND time_us > (extract(epoch FROM now()) * 1000000)::bigint - $1::bigint"
    " ORDER BY time_us DESC LIMIT {}";

// Selects the newest state of every change that began between two times.
constexpr const char* kRecords =
    "SELECT DISTINCT ON (building, id) building, place, state, value, std_error FROM event"
    " WHERE kind = 'stiffness_change' AND since_us BETWEEN $1 AND $2"
    " ORDER BY building, id, time_us DESC";

/// A building of the list with its sort keys.
struct Judgement {
  const ComparedBuilding* building = nullptr;
  const Comparison* worst = nullptr;  ///< the largest significant loss, else the largest loss
  std::size_t compared = 0, losses = 0;
  std::vector<std::string> not_observable;

  int rank() const { return losses > 0 ? 0 : compared > 0 ? 1 : building->period_s > 0 ? 2 : 3; }
  const char* word() const {
    constexpr const char* kWords[] = {"loss", "none", "not_observable", "nothing"};
    return kWords[rank()];
  }
  double loss() const { return worst == nullptr ? 0 : -worst->ratio; }
};

bool is_loss(const Comparison& c, double limit) {
  return c.compared && (c.told ? c.ratio < 0 : c.times_error() < -limit);
}

/// Replaces the size of a change that the building recorded with the recorded size.
bool take_records(Database& database, std::int64_t from_us, std::int64_t to_us,
                  std::map<std::int64_t, ComparedBuilding>& buildings) {
  const auto rows = database.query(kRecords, {std::to_string(from_us), std::to_string(to_us)});
  if (!rows) return false;
  for (const Database::Row& row : *rows) {
    const auto building = buildings.find(integer_at(row, 0));
    const auto value = number_at(row, 3), std_error = number_at(row, 4);
    if (building == buildings.end() || integer_at(row, 2) == 0 || !value || !std_error) continue;
    if (!std::isfinite(*value) || !(*std_error > 0)) continue;
    for (Comparison& c : building->second.stiffness) {
      if (c.name != text_at(row, 1)) continue;
      c.compared = c.told = true;
      c.ratio = *value / 100;
      c.std_error = *std_error / 100;
    }
  }
  return true;
}

Judgement judge(const ComparedBuilding& building, double limit) {
  Judgement out{&building, nullptr, 0, 0, {}};
  for (const Comparison& c : building.stiffness) {
    if (!c.compared) {
      out.not_observable.push_back(c.name);
      continue;
    }
    ++out.compared;
    const bool loss = is_loss(c, limit);
    out.losses += loss ? 1 : 0;
    const bool was = out.worst != nullptr && is_loss(*out.worst, limit);
    if (out.worst == nullptr || (loss && !was) || (loss == was && c.ratio < out.worst->ratio))
      out.worst = &c;
  }
  return out;
}

json comparison_json(const Comparison& c, double limit) {
  json out{{"parameter", c.name}, {"unit", c.unit}};
  if (c.before.periods > 0) out["before"] = c.before.value;
  if (c.after.periods > 0) out["after"] = c.after.value;
  if (!c.compared) return out;
  out["ratio"] = c.ratio;
  out["std_error"] = c.std_error;
  out["significant"] = c.told || (c.std_error > 0 && std::abs(c.times_error()) > limit);
  out["told"] = c.told;
  return out;
}

json judgement_json(const Judgement& j, double limit, bool all) {
  const ComparedBuilding& b = *j.building;
  json out{{"name", b.name},         {"title", b.title},
           {"place", b.place},       {"result", j.word()},
           {"period_s", b.period_s}, {"before", b.before},
           {"after", b.after},       {"compared", j.compared},
           {"losses", j.losses},     {"not_observable", j.not_observable}};
  if (j.worst != nullptr) out["worst"] = comparison_json(*j.worst, limit);
  if (!all) return out;
  out["parameters"] = json::array();
  for (const Comparison& c : b.stiffness) out["parameters"].push_back(comparison_json(c, limit));
  return out;
}

}  // namespace

std::string earthquake_json(Database& database, const EarthquakeRequest& r) {
  const auto rows = database.query(kComparedBuildings, {r.building});
  if (!rows) return json{{"problem", database.error()}}.dump();
  std::map<std::int64_t, ComparedBuilding> buildings;
  for (const Database::Row& row : *rows)
    buildings[integer_at(row, 0)] = {
        text_at(row, 1), text_at(row, 2), text_at(row, 3), 0, 0, 0, {}};
  PeriodReader reader(database);
  const std::int64_t t = r.time_us;
  using R = EarthquakeRequest;
  const ComparedTime minutes{60, t - R::kBefore_us, t, t + R::kSettle_us, t + R::kAfter_us};
  const ComparedTime tens{600, t - R::kLongBefore_us, t, t + R::kSettle_us, t + R::kLongAfter_us};
  if (!reader.read(buildings, minutes, R::kMinPeriods) ||
      !reader.read(buildings, tens, R::kMinPeriods) || !reader.read(buildings, tens, 1) ||
      !reader.read(buildings, minutes, 1) ||
      !take_records(database, t - kTogether_us, t + R::kLongAfter_us, buildings))
    return json{{"problem", database.error()}}.dump();
  std::size_t compared = 0;
  for (const auto& [id, building] : buildings)
    for (const Comparison& c : building.stiffness) compared += c.compared ? 1 : 0;
  const double limit = significant_errors(compared);
  std::vector<Judgement> all;
  for (const auto& [id, building] : buildings) all.push_back(judge(building, limit));
  std::sort(all.begin(), all.end(), [](const Judgement& a, const Judgement& b) {
    return std::tuple(a.rank(), -a.loss(), a.building->name) <
           std::tuple(b.rank(), -b.loss(), b.building->name);
  });
  json list = json::array();
  for (const Judgement& one : all) list.push_back(judgement_json(one, limit, !r.building.empty()));
  return json{{"time_us", t}, {"times_error", limit}, {"compared", compared}, {"buildings", list}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string earthquakes_json(Database& database, int days) {
  const auto rows =
      database.query(fmt::format(kShaken, kMaxEvents), {std::to_string(days * daemon::kDay_us)});
  if (!rows) return json{{"problem", database.error()}}.dump();
  std::vector<std::pair<std::int64_t, std::int64_t>> shaken;  // since_us, building
  for (const Database::Row& row : *rows)
    shaken.emplace_back(integer_at(row, 1), integer_at(row, 0));
  std::sort(shaken.begin(), shaken.end());
  json out = json::array();
  for (std::size_t from = 0; from < shaken.size();) {
    std::size_t to = from;
    std::set<std::int64_t> together;
    for (; to < shaken.size() && shaken[to].first - shaken[from].first <= kTogether_us; ++to)
      together.insert(shaken[to].second);
    if (together.size() < kMinTogether) {
      ++from;
      continue;
    }
    out.push_back({{"time_us", shaken[from].first},
                   {"until_us", shaken[to - 1].first},
                   {"buildings", together.size()}});
    from = to;
  }
  std::reverse(out.begin(), out.end());
  while (out.size() > kMaxEarthquakes) out.erase(out.size() - 1);
  return out.dump();
}

}  // namespace framewatch::fleet
