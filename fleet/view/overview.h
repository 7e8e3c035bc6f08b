#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>

#include "fleet/store/database.h"

namespace framewatch::fleet {

/// What a building needs of people, the most urgent first.
enum class Urgency {
  alarm,    ///< an alarm is raised that nobody acknowledged
  warning,  ///< a warning is
  silent,   ///< no heartbeat for kSilent_us
  changed,  ///< information alone is raised
  known,    ///< what is raised is acknowledged
  well
};
const char* urgency_word(Urgency urgency);

/// What the hub knows of a building now. Times: the database's clock, but of events.
struct BuildingState {
  static constexpr std::int64_t kSilent_us = 180'000'000;

  std::string name, title, place;
  std::optional<double> latitude, longitude;  ///< degrees, north and east positive
  std::int64_t first_us = 0;                  ///< when it was first heard of
  std::optional<std::int64_t> heard_us;       ///< the newest heartbeat
  std::vector<event_t> raised;                ///< not cleared, oldest first
  std::map<std::int64_t, std::string> known;  ///< who acknowledged an event, by its id

  bool is_known(const event_t& event) const { return known.contains(event.id); }
  /// Whether there was no heartbeat for kSilent_us.
  bool is_silent(std::int64_t now_us) const;
};

struct Judged {
  Urgency urgency = Urgency::well;
  std::int64_t since_us = 0;  ///< 0: well
  std::string message;        ///< one sentence; empty: well
};
/// The most urgent of what is raised, and silence.
Judged judged(const BuildingState& state, std::int64_t now_us);

/// Brings what is raised up to date: a raised or changed event is added or takes its place, a
/// cleared one goes.
void note_event(std::vector<event_t>& raised, const event_t& event);

struct Overview {
  std::int64_t now_us = 0;               ///< the database's clock
  std::vector<BuildingState> buildings;  ///< by name
  std::string problem;                   ///< empty, or why there are none
};
/// What the newest heartbeats say, and events that came after them. `only`: of this building alone;
/// empty: of every one that is not retired.
Overview read_overview(Database& database, const std::string& only = "");

/// {"now_us", "heard_us": newest heartbeat of all, "counts": {URGENCY: n}, "buildings": [{"name",
/// "title", "place", "latitude", "longitude", "urgency", "since_us", "message", "raised"}]}, the
/// most urgent first, among equals the newest.
std::string overview_json(const Overview& overview);

}  // namespace framewatch::fleet
