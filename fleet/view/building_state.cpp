#include "fleet/view/building_state.h"

#include <algorithm>

#include "daemon/monitor/events/event_messages.h"

namespace framewatch::fleet {
namespace {

Urgency urgency_of(const BuildingState& state, const event_t& event) {
  if (event.severity <= daemon::severity::information) return Urgency::changed;
  if (state.is_known(event)) return Urgency::known;
  return event.severity >= daemon::severity::alarm ? Urgency::alarm : Urgency::warning;
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
         state.heard_us ? "nothing is heard of it" : "no heartbeat has ever come");
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

}  // namespace framewatch::fleet
