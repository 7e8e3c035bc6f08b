#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <framewatch/event_t.hpp>

#include "daemon/config/keys/event_report_options.h"

namespace framewatch::daemon {

/// Decides which events are delivered, when and in which order; bounded. Of each event only the
/// newest news waits. Pure: times are the caller's, of a clock that is never set.
class ActionQueue {
 public:
  static constexpr std::size_t kMax = 256;            ///< events that wait
  static constexpr std::size_t kMaxDelivered = 4096;  ///< that are remembered as raised

  void configure(const ActionSettings& settings) { settings_ = settings; }
  /// The event was delivered before this began: only its end is to be delivered.
  void delivered_before(const event_t& event);
  /// Queues an event. acknowledged: only its end is delivered. Returns how many events are lost:
  /// when the queue is full, the least severe one.
  int put(const event_t& event, bool acknowledged, std::int64_t now_us);
  /// Somebody has acknowledged the event: only its end is still delivered.
  void acknowledged(const event_t& event);
  /// The next event to deliver; empty when none is due.
  std::optional<event_t> take(std::int64_t now_us);
  /// The next event whatever the rate limit says: the program stops.
  std::optional<event_t> take_any();
  std::size_t waiting() const { return waiting_.size(); }
  std::int64_t merged() const { return merged_; }  ///< news replaced by newer news of the event

 private:
  using Key = std::pair<std::string, std::int64_t>;  ///< kind and id
  struct Waiting {
    event_t event;
    std::int64_t due_us, order;
  };

  bool wanted(const event_t& event) const;
  void remember(const Key& key, std::int64_t now_us);

  ActionSettings settings_;
  std::map<Key, Waiting> waiting_;
  std::map<Key, std::int64_t> delivered_us_;  ///< when an event that is still raised was
  double tokens_ = -1;                        ///< negative: full
  std::int64_t filled_us_ = 0, order_ = 0, merged_ = 0;
};

}  // namespace framewatch::daemon
