// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>

#include "daemon/monitor/events/event_messages.h"

namespace framewatch::daemon {

template <typename Archive>
void archive_event(Archive& a, event_t& e) {
  a(e.time_us, e.since_us, e.id, e.state, e.severity, e.kind, e.place, e.value, e.std_error, e.unit,
    e.message, e.segment);
}

/// The events that are raised and not yet cleared, in the order in which they were raised, and who
/// acknowledged them.
class RaisedEvents {
 public:
  static constexpr std::size_t kMax = 1000;  ///< with more events, the oldest one is forgotten

  /// Adds a raised event or replaces it; removes a cleared one with its acknowledgement.
  void note(const event_t& event);
  /// Removes and returns the events of this kind.
  std::vector<event_t> take(const std::string& kind);
  const std::vector<event_t>& all() const { return events_; }
  /// Returns nullptr if no event of this kind is raised at this place.
  const event_t* find(const std::string& kind, const std::string& place) const;
  /// Acknowledges a raised event; replaces an earlier acknowledgement.
  void acknowledge(std::int64_t id, const Acknowledgement& by);
  /// Returns nullptr if the event is not acknowledged.
  const Acknowledgement* acknowledgement(std::int64_t id) const;

  template <typename Archive>
  void archive(Archive& a) {
    events_.resize(a.count(events_.size()));
    for (event_t& e : events_) archive_event(a, e);
    acknowledged_.resize(a.count(acknowledged_.size()));
    for (Acknowledged& k : acknowledged_) a(k.id, k.by);
  }

 private:
  struct Acknowledged {
    std::int64_t id = 0;
    Acknowledgement by;
  };
  void forget(std::int64_t id);

  std::vector<event_t> events_;
  std::vector<Acknowledged> acknowledged_;
};

}  // namespace framewatch::daemon
