#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <framewatch/event_t.hpp>

#include "daemon/action_options.h"

namespace framewatch::daemon {

/// Which events are told to somebody, and in which order; bounded. Of one event only the newest
/// waits. Pure: the clock, which is never set, is the caller's.
class ActionQueue {
 public:
  static constexpr std::size_t kMost = 256;  ///< events that wait
  static constexpr std::size_t kMostTold = 4096;

  void configure(const ActionSettings& settings) { settings_ = settings; }
  /// It was raised and told before this began: its end is to be told.
  void told_before(const event_t& event);
  /// acknowledged: somebody knows; only its end is told. Returns how many events are lost by it: of
  /// too many, the least severe one is.
  int put(const event_t& event, bool acknowledged, std::int64_t now_us);
  /// Somebody knows of it: only that it is over is still told.
  void acknowledged(const event_t& event);
  /// The next to be told; empty when none is due.
  std::optional<event_t> take(std::int64_t now_us);
  /// The same, however many were told lately: nothing is to come any more.
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
  std::map<Key, std::int64_t> told_us_;  ///< raised as far as they were told
  double tokens_ = -1;                   ///< negative: full
  std::int64_t filled_us_ = 0, order_ = 0, merged_ = 0;
};

}  // namespace framewatch::daemon
