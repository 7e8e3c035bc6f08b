#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>

#include "daemon/acknowledgement.h"
#include "daemon/event_words.h"

namespace framewatch::daemon {

/// The events that are raised and not cleared, in the order they were raised, and who knows of
/// them.
class RaisedEvents {
 public:
  static constexpr std::size_t kMost = 1000;  ///< beyond, the oldest one is forgotten

  void note(const event_t& e) {
    const auto same = std::find_if(events_.begin(), events_.end(),
                                   [&](const event_t& r) { return r.id == e.id; });
    if (e.state == event_state::cleared) {
      if (same != events_.end()) events_.erase(same);
      forget(e.id);
    } else if (same != events_.end()) {
      *same = e;
    } else {
      if (events_.size() == kMost) {
        forget(events_.front().id);
        events_.erase(events_.begin());
      }
      events_.push_back(e);
    }
  }
  /// Those of a kind, no longer raised.
  std::vector<event_t> take(const std::string& kind) {
    const auto others = std::stable_partition(events_.begin(), events_.end(),
                                              [&](const event_t& e) { return e.kind != kind; });
    const std::vector<event_t> taken(others, events_.end());
    events_.erase(others, events_.end());
    return taken;
  }
  const std::vector<event_t>& all() const { return events_; }
  /// Of an event that is raised; the last one counts.
  void acknowledge(std::int64_t id, const Acknowledgement& by) {
    forget(id);
    known_.push_back({id, by});
  }
  /// Null when nobody has acknowledged it.
  const Acknowledgement* acknowledgement(std::int64_t id) const {
    for (const Known& k : known_)
      if (k.id == id) return &k.by;
    return nullptr;
  }

  template <typename Archive>
  void archive(Archive& a) {
    events_.resize(a.count(events_.size()));
    for (event_t& e : events_)
      a(e.time_us, e.since_us, e.id, e.state, e.severity, e.kind, e.place, e.value, e.std_error,
        e.unit, e.message, e.segment);
    known_.resize(a.count(known_.size()));
    for (Known& k : known_) a(k.id, k.by);
  }

 private:
  struct Known {
    std::int64_t id = 0;
    Acknowledgement by;
  };
  void forget(std::int64_t id) {
    std::erase_if(known_, [id](const Known& k) { return k.id == id; });
  }

  std::vector<event_t> events_;
  std::vector<Known> known_;
};

}  // namespace framewatch::daemon
