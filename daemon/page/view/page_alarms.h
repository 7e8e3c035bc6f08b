// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/service_t.hpp>

#include "daemon/monitor/events/event_messages.h"
#include "daemon/page/findings/finding.h"

namespace framewatch::daemon {

/// Holds the events that the page lists and who acknowledged them. Every function that changes
/// events returns them as JSON for the viewers. `framewatch run` reports its raised events every
/// second; the page shows exactly those, and the events that it found itself.
class PageAlarms {
 public:
  static constexpr std::size_t kMax = 1000;  ///< events; above it cleared ones are forgotten

  /// Loads stored events in order of time. Raised ones stay raised until still_raised().
  void restore(const std::vector<event_t>& events);
  /// Adds or updates an event that `framewatch run` found.
  std::string note(const event_t& event);
  /// Adds or updates an event that the page found.
  std::string note_own(const event_t& event);
  /// Adds the raised events of `framewatch run` that the page lacks and clears the events that
  /// `framewatch run` no longer has, as after a restart or a lost message. Keeps the page's own
  /// events.
  std::vector<std::string> still_raised(const service_t& service);
  /// Takes the acknowledgements of `framewatch run` and returns the events whose acknowledgement
  /// changed. When all events were acknowledged at once, the page's own events are included.
  std::vector<std::string> acknowledged(acknowledged_t news);
  /// Acknowledges an event that only the page knows.
  std::string acknowledge(std::int64_t id);

  /// Returns nullptr when the event does not exist.
  const event_t* find(std::int64_t id) const;
  /// Returns true when `framewatch run` keeps acknowledgements.
  bool kept_elsewhere() const { return acknowledged_.has_value(); }
  /// Returns every event as JSON.
  std::vector<std::string> all() const;
  /// Returns the raised events, sorted by severity and then by age.
  std::vector<Finding> findings(const Config& config) const;

 private:
  /// Returns nullopt when the event is not acknowledged.
  std::optional<Acknowledgement> acknowledgement(const event_t& event) const;
  std::string json(const event_t& event) const;
  std::string put(const event_t& event);
  std::set<std::int64_t> acknowledge_own(const acknowledged_t& news);

  std::map<std::int64_t, event_t> events_;
  std::set<std::int64_t> own_;  ///< that the page found
  std::map<std::int64_t, Acknowledgement>
      acknowledged_here_;                       ///< `framewatch run` does not keep it
  std::int64_t all_acknowledged_us_ = 0;        ///< host clock of `framewatch run`; 0: never
  std::optional<acknowledged_t> acknowledged_;  ///< the newest from `framewatch run`
};

}  // namespace framewatch::daemon
