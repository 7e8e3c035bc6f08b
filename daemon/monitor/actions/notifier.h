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

/// The outcome of one attempt to deliver an event.
struct DeliveryResult {
  std::string trouble = {};  ///< why it was not delivered; empty: it was
  bool retry = false;        ///< another attempt may succeed
};

/// Whether the delivery is to be given up, because the program stops.
using Abandoned = std::function<bool()>;

/// Delivers events to one receiver (a command or a webhook) from a thread of its own, so that the
/// caller never waits. Failed deliveries are repeated with growing pauses, for
/// the receiver's patience (0: not at all).
class Notifier {
 public:
  using Deliver =
      std::function<DeliveryResult(const ActionSettings&, const event_t&, const Abandoned&)>;

  struct Counters {
    std::int64_t told = 0, lost = 0, merged = 0;  ///< delivered, lost, replaced by newer news
    std::int64_t waiting = 0;
    std::int64_t lost_us = 0;  ///< host clock when one was last lost; 0: never
    std::string trouble;       ///< of the newest attempt; empty: it succeeded
  };

  /// `name`: in log lines. Delivers nothing before configure().
  Notifier(std::string name, Deliver deliver);
  /// Delivers what is queued, for two seconds at most; the rest is lost, and the log says so.
  ~Notifier();
  Notifier(const Notifier&) = delete;
  Notifier& operator=(const Notifier&) = delete;

  /// patience_s: how long attempts to deliver one event are repeated.
  void configure(const ActionSettings& settings, double patience_s);
  /// An event that an earlier run has delivered: only its end is delivered.
  void delivered_before(const event_t& event);
  /// Queues an event. acknowledged: only its end is delivered.
  void event(const event_t& event, bool acknowledged);
  /// Somebody has acknowledged the event: only its end is still delivered.
  void acknowledged(const event_t& event);
  Counters counters() const;

 private:
  void work();
  bool deliver_one(ActionSettings settings, double patience_s, const event_t& event);
  void lose(std::int64_t events, const std::string& why);
  bool abandoned() const;

  const std::string name_;
  const Deliver deliver_;
  mutable std::mutex mutex_;  ///< guards what is below
  std::condition_variable wake_;
  ActionSettings settings_;
  double patience_s_ = 0;
  ActionQueue queue_;
  Counters counters_;
  RateLimitedLog losses_{LogLevel::error};
  bool stop_ = false;
  std::int64_t give_up_us_ = INT64_MAX;  ///< steady clock
  std::thread thread_;                   ///< last: it sees everything above
};

}  // namespace framewatch::daemon
