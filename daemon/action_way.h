#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include <framewatch/event_t.hpp>

#include "daemon/action_queue.h"
#include "daemon/log.h"

namespace framewatch::daemon {

/// What came of telling somebody once.
struct Told {
  std::string trouble = {};  ///< why nobody was told; empty: somebody was
  bool again = false;        ///< trying again may help
};

/// Nobody waits for the answer any more.
using Abandoned = std::function<bool()>;

/// One way of telling somebody about events, from a thread of its own: whoever has news never
/// waits.
class ActionWay {
 public:
  using Tell = std::function<Told(const ActionSettings&, const event_t&, const Abandoned&)>;

  struct Counters {
    std::int64_t told = 0, lost = 0, merged = 0;  ///< events; news that newer news replaced
    std::int64_t waiting = 0;
    std::int64_t lost_us = 0;  ///< host clock when one was last lost; 0: never
    std::string trouble;       ///< of the newest try; empty: it worked
  };

  /// `name`: in log lines. Does nothing before it is configured.
  ActionWay(std::string name, Tell tell);
  /// Tells what waits, for two seconds at most; what is left is lost, and the log says so.
  ~ActionWay();
  ActionWay(const ActionWay&) = delete;
  ActionWay& operator=(const ActionWay&) = delete;

  /// patience_s: how long telling one event is tried again.
  void configure(const ActionSettings& settings, double patience_s);
  void told_before(const event_t& event);
  void event(const event_t& event, bool acknowledged);
  /// Somebody knows of it.
  void acknowledged(const event_t& event);
  Counters counters() const;

 private:
  void work();
  bool tell_one(ActionSettings settings, double patience_s, const event_t& event);
  void lose(std::int64_t events, const std::string& why);
  bool abandoned() const;

  const std::string name_;
  const Tell tell_;
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
