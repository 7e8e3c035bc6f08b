#include "daemon/monitor/events/event_json.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/events/event_words.h"

namespace framewatch::daemon {

std::string event_json(const event_t& e, const std::string& building) {
  const Json out{{"schema", "framewatch.event/1"},
                 {"news", fmt::format("{}/{}/{}/{}", e.kind, e.id, e.time_us, e.state)},
                 {"building", building},
                 {"id", e.id},
                 {"state", word(kEventStates, e.state)},
                 {"severity", word(kSeverities, e.severity)},
                 {"kind", e.kind},
                 {"place", e.place},
                 {"message", e.message},
                 {"value", json_value(e.value)},
                 {"std_error", json_value(e.std_error)},
                 {"unit", e.unit},
                 {"segment", e.segment},
                 {"time", utc_text(e.time_us)},
                 {"time_us", e.time_us},
                 {"since", utc_text(e.since_us)},
                 {"since_us", e.since_us}};
  return json_line(out);
}

}  // namespace framewatch::daemon
