// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <framewatch/event_t.hpp>

#include "daemon/base/log.h"
#include "daemon/config/keys/action_options.h"
#include "daemon/monitor/actions/quiet_hours.h"

namespace framewatch::daemon {

/// Kind of the daily message that all is well, or what is not. It is delivered whatever its
/// severity.
inline constexpr const char* kWellKind = "well";

/// Decides which events are delivered, when and in which order, with a bounded queue. Of each event
/// only the newest news waits. Uses no clock: callers pass the time of a clock that is never set.
class ActionQueue {
 public:
  static constexpr std::size_t kMax = 256;            ///< waiting events
  static constexpr std::size_t kMaxDelivered = 4096;  ///< remembered raised events

  void configure(const ActionSettings& settings) { settings_ = settings; }
  /// Tells that an earlier run has delivered the event: only its end is delivered.
  void delivered_before(const event_t& event);
  /// Queues an event. Of an `acknowledged` event only the end is delivered. Returns the number of
  /// lost events: if the queue is full, the least severe one is dropped.
  int put(const event_t& event, bool acknowledged, std::int64_t now_us);
  /// Tells that the event was acknowledged: only its end is still delivered.
  void acknowledged(const event_t& event);
  /// Returns the next event to deliver; nullopt if no event is due. Events below `least_severity`
  /// go on waiting.
  std::optional<event_t> take(std::int64_t now_us, int least_severity = 0);
  /// Returns the most severe event regardless of the rate limit, for the end of the program.
  std::optional<event_t> take_any();
  std::size_t waiting() const { return waiting_.size(); }
  /// Returns how much news was replaced by newer news of the same event.
  std::int64_t merged() const { return merged_; }

 private:
  using Key = std::pair<std::string, std::int64_t>;  ///< kind and id
  struct Waiting {
    event_t event;
    std::int64_t due_us, order;
    /// Returns true if this is sent before `other`: the more severe first, then the older.
    bool goes_before(const Waiting& other) const {
      return std::pair(-event.severity, order) < std::pair(-other.event.severity, other.order);
    }
  };

  bool wanted(const event_t& event) const;
  void remember(const Key& key, std::int64_t now_us);

  ActionSettings settings_;
  std::map<Key, Waiting> waiting_;
  std::map<Key, std::int64_t> delivered_us_;  ///< when a raised event was delivered
  double tokens_ = -1;                        ///< negative: full
  std::int64_t filled_us_ = 0, order_ = 0, merged_ = 0;
};

/// The outcome of one attempt to deliver an event.
struct DeliveryResult {
  std::string trouble = {};  ///< why it was not delivered; empty: delivered
  bool retry = false;        ///< another attempt may succeed
  double retry_after_s = 0;  ///< shortest pause that the receiver asks for; 0: none
  std::string answer = {};   ///< what the receiver said, in its words
  bool partly = false;       ///< delivered, but not to everybody: `trouble` says to whom not
};

/// Returns true if the delivery should be given up because the program stops.
using Abandoned = std::function<bool()>;

/// Delivers events to one receiver (a command, a webhook or a mail server) from a thread, so that
/// the caller never waits. Repeats failed deliveries with growing pauses for the time that
/// configure() sets.
class Notifier {
 public:
  using Deliver =
      std::function<DeliveryResult(const ActionSettings&, const event_t&, const Abandoned&)>;

  struct Counters {
    std::int64_t told = 0, lost = 0, merged = 0;  ///< delivered, lost, replaced by newer news
    std::int64_t waiting = 0;
    std::int64_t lost_us = 0;  ///< host clock at the last loss; 0: no loss
    std::string trouble;       ///< of the newest attempt; empty: success
  };

  /// `name` is for log lines. Delivers nothing before configure().
  Notifier(std::string name, Deliver deliver);
  /// Delivers queued events for two seconds at most, also in quiet hours. Logs how many are lost.
  ~Notifier();

  /// `patience_s`: how long attempts to deliver one event are repeated; 0: a single attempt.
  void configure(const ActionSettings& settings, double patience_s);
  // As in ActionQueue.
  void delivered_before(const event_t& event);
  void event(const event_t& event, bool acknowledged);
  /// Also ends the repetition of a failed delivery.
  void acknowledged(const event_t& event);
  Counters counters() const;

 private:
  void work();
  bool deliver_one(ActionSettings settings, double patience_s, const event_t& event);
  void lose(std::int64_t events, const std::string& why);
  bool abandoned() const;

  const std::string name_;
  const Deliver deliver_;
  mutable std::mutex mutex_;  ///< guards the members below
  std::condition_variable wake_;
  ActionSettings settings_;
  double patience_s_ = 0;
  QuietHours quiet_;
  ActionQueue queue_;
  Counters counters_;
  RateLimitedLog losses_{LogLevel::error};
  bool stop_ = false;
  /// Kind and id of the event that is being delivered, if its acknowledgement makes it needless.
  std::optional<std::pair<std::string, std::int64_t>> repeatable_;
  bool needless_ = false;                ///< it was acknowledged meanwhile
  std::int64_t give_up_us_ = INT64_MAX;  ///< steady clock
  std::thread thread_;                   ///< last, because it uses the members above
};

}  // namespace framewatch::daemon
