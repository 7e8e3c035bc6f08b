// SPDX-License-Identifier: MIT
#include "daemon/monitor/events/raised_events.h"

#include <algorithm>

namespace framewatch::daemon {

void RaisedEvents::note(const event_t& e) {
  const auto same = std::ranges::find(events_, e.id, &event_t::id);
  if (e.state == event_state::cleared) {
    if (same != events_.end()) events_.erase(same);
    forget(e.id);
  } else if (same != events_.end()) {
    *same = e;
  } else {
    if (events_.size() == kMax) {
      forget(events_.front().id);
      events_.erase(events_.begin());
    }
    events_.push_back(e);
  }
}

std::vector<event_t> RaisedEvents::take(const std::string& kind) {
  const auto others = std::stable_partition(events_.begin(), events_.end(),
                                            [&](const event_t& e) { return e.kind != kind; });
  std::vector<event_t> taken(others, events_.end());
  events_.erase(others, events_.end());
  return taken;
}

const event_t* RaisedEvents::find(const std::string& kind, const std::string& place) const {
  for (const event_t& e : events_)
    if (e.kind == kind && e.place == place) return &e;
  return nullptr;
}

void RaisedEvents::acknowledge(std::int64_t id, const Acknowledgement& by) {
  forget(id);
  acknowledged_.push_back({id, by});
}

const Acknowledgement* RaisedEvents::acknowledgement(std::int64_t id) const {
  for (const Acknowledged& a : acknowledged_)
    if (a.id == id) return &a.by;
  return nullptr;
}

void RaisedEvents::forget(std::int64_t id) {
  std::erase_if(acknowledged_, [id](const Acknowledged& a) { return a.id == id; });
}

}  // namespace framewatch::daemon
