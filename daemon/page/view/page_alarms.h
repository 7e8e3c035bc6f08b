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

/// The events that the page lists, and who acknowledged them. What changes comes back as JSON for
/// the viewers. `framewatch run` says every second which of its events are raised: the page shows
/// those and no others.
class PageAlarms {
 public:
  static constexpr std::size_t kMax = 1000;  ///< beyond, a cleared one is forgotten

  /// Events that were stored before the page's server began, in order of time. Those that are
  /// raised are so until `framewatch run` says which still are.
  void restore(const std::vector<event_t>& events);
  /// News of an event that `framewatch run` found.
  std::string note(const event_t& event);
  /// News of an event that the page found.
  std::string note_own(const event_t& event);
  /// Takes over the report of `framewatch run`: adds the events that it has and the page has not,
  /// and ends those that it no longer has, because it was started anew without them or because the
  /// message of their end was lost. Events of the page stay.
  std::vector<std::string> still_raised(const service_t& service);
  /// What `framewatch run` says is acknowledged; the events whose acknowledgement changed. When
  /// everything was acknowledged at once, that is true of the page's own events, too.
  std::vector<std::string> acknowledged(acknowledged_t news);
  /// An event that only the page knows is acknowledged.
  std::string acknowledge(std::int64_t id);

  /// Null when there is no such event.
  const event_t* find(std::int64_t id) const;
  /// Whether `framewatch run` keeps acknowledgements.
  bool kept_elsewhere() const { return acknowledged_.has_value(); }
  /// Every event.
  std::vector<std::string> all() const;
  /// What is raised and not cleared, by severity and then by age.
  std::vector<Finding> findings(const Config& config) const;

 private:
  /// Empty: nobody acknowledged it.
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
