// SPDX-License-Identifier: MIT
#include "fleet/view/overview.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/service_t.hpp>

#include "daemon/monitor/events/event_messages.h"
#include "drivers/lcm/message_check.h"
#include "fleet/view/rows.h"

namespace framewatch::fleet {
namespace {

Urgency urgency_of(const BuildingState& state, const event_t& event) {
  if (event.severity <= daemon::severity::information) return Urgency::changed;
  if (state.is_known(event)) return Urgency::known;
  return event.severity >= daemon::severity::alarm ? Urgency::alarm : Urgency::warning;
}

using nlohmann::json;

constexpr int kMaxNewEvents = 1000;  // of each building after its heartbeat

constexpr const char* kHeartbeats =
    "SELECT b.id, b.name, b.title, b.place, b.latitude, b.longitude, {}, {}, n.content, {}"
    " FROM building b LEFT JOIN newest n ON n.building = b.id AND n.kind = 'service'"
    " WHERE CASE WHEN $1 = '' THEN NOT b.retired ELSE b.name = $1 END ORDER BY b.name";
// Includes events that came at the same time as the heartbeat, because their order is unknown. An
// event that the heartbeat already has changes nothing.
constexpr const char* kNewEvents =
    "SELECT b.id, e.id, e.state, e.severity, e.kind, e.place, e.since_us, e.time_us, e.message"
    " FROM building b LEFT JOIN newest n ON n.building = b.id AND n.kind = 'service'"
    " JOIN LATERAL (SELECT * FROM event WHERE building = b.id AND came >= coalesce(n.came,"
    " '-infinity') ORDER BY came DESC LIMIT {}) e ON true"
    " WHERE $1 = '' OR b.name = $1 ORDER BY e.time_us, e.came";
constexpr const char* kOrdered =
    "SELECT a.building, j.content, j.who FROM journal j JOIN journal_answer a ON a.request = "
    "j.request"
    " WHERE j.verb = 'acknowledge' AND a.done AND j.came > now() - interval '400 days'";
constexpr const char* kAcknowledged =
    "SELECT building, content FROM newest WHERE kind = 'acknowledged'";

void take_heartbeat(BuildingState& state, const Database::Row& row) {
  if (!row[7]) return;
  state.heard_us = integer_at(row, 7);
  const auto service = drivers::decoded<service_t>(bytes_at(row, 8));
  if (!service) return;
  for (std::size_t i = 0; i < service->event_id.size(); ++i) {
    event_t event{};
    event.id = service->event_id[i];
    event.since_us = service->event_since_us[i];
    event.time_us = event.since_us;
    event.severity = service->event_severity[i];
    event.kind = service->event_kind[i];
    event.place = service->event_place[i];
    event.message = service->event_message[i];
    event.state = 1;
    state.raised.push_back(std::move(event));
  }
}

event_t event_of(const Database::Row& row) {
  event_t event{};
  event.id = integer_at(row, 1);
  event.state = static_cast<std::int32_t>(integer_at(row, 2));
  event.severity = static_cast<std::int32_t>(integer_at(row, 3));
  event.kind = text_at(row, 4);
  event.place = text_at(row, 5);
  event.since_us = integer_at(row, 6);
  event.time_us = integer_at(row, 7);
  event.message = text_at(row, 8);
  return event;
}

using Index = std::map<std::int64_t, std::size_t>;  ///< places in the overview by building

/// Notes events that a person acknowledged on this page.
void note_orders(Overview& overview, const Index& index, const Rows& orders) {
  for (const Database::Row& row : orders) {
    const json content = json::parse(text_at(row, 1), nullptr, false);
    const auto at = index.find(integer_at(row, 0));
    if (at == index.end() || !content.is_object() || !content.contains("id") ||
        !content["id"].is_number_integer())
      continue;
    overview.buildings[at->second].known[content["id"].get<std::int64_t>()] = text_at(row, 2);
  }
}

/// Notes events that the buildings report as acknowledged.
void note_acknowledged(Overview& overview, const Index& index, const Rows& said) {
  for (const Database::Row& row : said) {
    const auto at = index.find(integer_at(row, 0));
    const auto message = drivers::decoded<acknowledged_t>(bytes_at(row, 1));
    if (at == index.end() || !message) continue;
    for (std::size_t i = 0; i < message->id.size(); ++i)
      overview.buildings[at->second].known.try_emplace(message->id[i], message->who[i]);
  }
}

}  // namespace

const char* urgency_word(Urgency urgency) {
  switch (urgency) {
    case Urgency::alarm:
      return "alarm";
    case Urgency::warning:
      return "warning";
    case Urgency::silent:
      return "silent";
    case Urgency::changed:
      return "changed";
    case Urgency::known:
      return "known";
    case Urgency::well:
      break;
  }
  return "well";
}

bool BuildingState::is_silent(std::int64_t now_us) const {
  return now_us - heard_us.value_or(first_us) > kSilent_us;
}

Judged judged(const BuildingState& state, std::int64_t now_us) {
  Judged out;
  const auto look = [&](Urgency urgency, std::int64_t since_us, const std::string& message) {
    if (urgency < out.urgency) out = {urgency, since_us, message};
  };
  for (const event_t& event : state.raised)
    look(urgency_of(state, event), event.since_us, event.message);
  if (state.is_silent(now_us))
    look(Urgency::silent, state.heard_us.value_or(state.first_us),
         state.heard_us ? "no heartbeat for over 3 minutes" : "no heartbeat has come yet");
  return out;
}

void note_event(std::vector<event_t>& raised, const event_t& event) {
  const auto same = [&](const event_t& other) { return other.id == event.id; };
  const auto found = std::find_if(raised.begin(), raised.end(), same);
  if (event.state == daemon::event_state::cleared) {
    if (found != raised.end()) raised.erase(found);
  } else if (found != raised.end()) {
    *found = event;
  } else {
    raised.push_back(event);
  }
}

Overview read_overview(Database& database, const std::string& only) {
  Overview out;
  const auto buildings = database.query(
      fmt::format(kHeartbeats, sql_us("b.first_seen"), sql_us("n.came"), sql_us("now()")), {only});
  if (!buildings) {
    out.problem = database.error();
    return out;
  }
  Index index;
  for (const Database::Row& row : *buildings) {
    BuildingState state{text_at(row, 1),
                        text_at(row, 2),
                        text_at(row, 3),
                        number_at(row, 4),
                        number_at(row, 5),
                        integer_at(row, 6),
                        {},
                        {},
                        {}};
    take_heartbeat(state, row);
    out.now_us = integer_at(row, 9);
    index[integer_at(row, 0)] = out.buildings.size();
    out.buildings.push_back(std::move(state));
  }
  const auto events = database.query(fmt::format(kNewEvents, kMaxNewEvents), {only});
  const auto orders = events ? database.query(kOrdered) : std::nullopt;
  const auto acknowledged = orders ? database.query(kAcknowledged) : std::nullopt;
  if (!acknowledged) {
    out.problem = database.error();
    return out;
  }
  for (const Database::Row& row : *events)
    if (const auto at = index.find(integer_at(row, 0)); at != index.end())
      note_event(out.buildings[at->second].raised, event_of(row));
  note_orders(out, index, *orders);
  note_acknowledged(out, index, *acknowledged);
  return out;
}

std::string overview_json(const Overview& overview) {
  json counts = json::object();
  std::int64_t heard_us = 0;
  std::vector<std::pair<Judged, const BuildingState*>> all;
  for (const BuildingState& state : overview.buildings) {
    all.emplace_back(judged(state, overview.now_us), &state);
    heard_us = std::max(heard_us, state.heard_us.value_or(0));
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.first.urgency, -a.first.since_us) <
           std::tuple(b.first.urgency, -b.first.since_us);
  });
  json list = json::array();
  for (int u = 0; u <= static_cast<int>(Urgency::well); ++u)
    counts[urgency_word(static_cast<Urgency>(u))] = 0;
  for (const auto& [verdict, state] : all) {
    const char* const word = urgency_word(verdict.urgency);
    counts[word] = counts[word].get<int>() + 1;
    json one{{"name", state->name},           {"title", state->title},
             {"place", state->place},         {"urgency", word},
             {"since_us", verdict.since_us},  {"message", verdict.message},
             {"raised", state->raised.size()}};
    if (state->latitude && state->longitude) {
      one["latitude"] = *state->latitude;
      one["longitude"] = *state->longitude;
    }
    list.push_back(std::move(one));
  }
  return json{
      {"now_us", overview.now_us}, {"heard_us", heard_us}, {"counts", counts}, {"buildings", list}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace framewatch::fleet
