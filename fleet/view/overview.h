// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>

#include "fleet/store/database.h"

namespace framewatch::fleet {

/// How urgently a building needs attention, most urgent first.
enum class Urgency {
  alarm,    ///< an alarm is raised and not acknowledged
  warning,  ///< a warning is raised and not acknowledged
  silent,   ///< no heartbeat for kSilent_us
  changed,  ///< only information is raised
  known,    ///< all raised events are acknowledged
  well
};
const char* urgency_word(Urgency urgency);

/// The state of a building as known to the hub. Times are of the database's clock, except in
/// events.
struct BuildingState {
  static constexpr std::int64_t kSilent_us = 180'000'000;

  std::string name, title, place;
  std::optional<double> latitude, longitude;  ///< degrees, north and east positive
  std::int64_t first_us = 0;                  ///< first message of the building
  std::optional<std::int64_t> heard_us;       ///< the newest heartbeat
  std::vector<event_t> raised;                ///< not cleared, oldest first
  std::map<std::int64_t, std::string> known;  ///< who acknowledged an event, by its id

  bool is_known(const event_t& event) const { return known.contains(event.id); }
  /// Returns true without a heartbeat for kSilent_us.
  bool is_silent(std::int64_t now_us) const;
};

struct Judged {
  Urgency urgency = Urgency::well;
  std::int64_t since_us = 0;  ///< 0: well
  std::string message;        ///< one sentence; empty: well
};
/// Returns the most urgent of the raised events and silence.
Judged judged(const BuildingState& state, std::int64_t now_us);

/// Updates the raised events: adds or replaces a raised or changed event, removes a cleared one.
void note_event(std::vector<event_t>& raised, const event_t& event);

struct Overview {
  std::int64_t now_us = 0;               ///< the database's clock
  std::vector<BuildingState> buildings;  ///< by name
  std::string problem;                   ///< why it could not be read; empty on success
};
/// Reads the newest heartbeats and the events that came after them. only: name of one building;
/// empty: all buildings that are not retired.
Overview read_overview(Database& database, const std::string& only = "");

/// Returns the buildings as JSON: {"now_us", "heard_us": newest heartbeat of all, "counts":
/// {URGENCY: n}, "buildings": [{"name", "title", "place", "latitude", "longitude", "urgency",
/// "since_us", "message", "raised"}]}, most urgent first, then newest first.
std::string overview_json(const Overview& overview);

}  // namespace framewatch::fleet
