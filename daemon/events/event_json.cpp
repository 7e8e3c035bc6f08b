#include "daemon/events/event_json.h"

#include <cmath>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/utc_time.h"
#include "daemon/events/event_words.h"

namespace framewatch::daemon {

std::string event_json(const event_t& e, const std::string& building) {
  using Json = nlohmann::ordered_json;
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
  const Json out{{"schema", "framewatch.event/1"},
                 {"news", fmt::format("{}/{}/{}/{}", e.kind, e.id, e.time_us, e.state)},
                 {"building", building},
                 {"id", e.id},
                 {"state", word(kEventStates, e.state)},
                 {"severity", word(kSeverities, e.severity)},
                 {"kind", e.kind},
                 {"place", e.place},
                 {"message", e.message},
                 {"value", number(e.value)},
                 {"std_error", number(e.std_error)},
                 {"unit", e.unit},
                 {"segment", e.segment},
                 {"time", utc_text(e.time_us)},
                 {"time_us", e.time_us},
                 {"since", utc_text(e.since_us)},
                 {"since_us", e.since_us}};
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace framewatch::daemon
