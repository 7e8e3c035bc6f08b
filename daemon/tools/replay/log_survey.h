#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/lcm/lcm_log.h"

namespace framewatch::daemon {

/// A damaged part of a log, between the intact events before and after it.
struct LostStretch {
  drivers::LogDamage damage;
  std::int64_t places = 1;  ///< more: of several, of which only the first is told
  bool truncated = false;
  std::optional<std::int64_t> before_us, after_us;  ///< event times
  /// By the events' numbers; negative: the numbers say nothing (a logger that was started anew).
  std::int64_t events = -1;
  /// Samples that are missing across it, by the nodes' sequence numbers.
  std::map<std::pair<std::string, std::int32_t>, std::int64_t> samples;
};

/// Counts, event by event, what a log contains and what is lost in it.
class LogSurvey {
 public:
  static constexpr std::size_t kMaxStretches = 10'000;  ///< the last holds all that come after

  void intact(const drivers::LogEvent& event);
  void damaged(const drivers::LogDamage& damage, bool truncated);

  std::int64_t events() const { return events_; }
  std::int64_t damaged_bytes() const;
  std::int64_t damaged_places() const;
  const std::vector<LostStretch>& lost() const { return lost_; }

 private:
  void count_samples(const drivers::LogEvent& event);

  /// The newest sequence number of a node, and at which stretch it stood before.
  struct Node {
    std::int64_t sequence = 0;
    std::size_t stretches = 0;
  };
  std::map<std::pair<std::string, std::int32_t>, Node> nodes_;
  std::vector<LostStretch> lost_;
  std::int64_t events_ = 0, last_number_ = -1, last_us_ = 0;
  bool open_ = false;  ///< the newest stretch has no event after it yet
};

}  // namespace framewatch::daemon
