#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fleet/store/database.h"
#include "fleet/view/building_state.h"

namespace framewatch::fleet {

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
