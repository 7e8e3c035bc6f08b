// SPDX-License-Identifier: MIT
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
  std::int64_t places = 1;  ///< above 1: several places, of which `damage` describes the first
  bool truncated = false;
  std::optional<std::int64_t> before_us, after_us;  ///< times of the intact events around it
  /// Events lost, by the events' numbers; negative: unknown, because the logger restarted.
  std::int64_t events = -1;
  /// Samples lost per channel and node, by the nodes' sequence numbers.
  std::map<std::pair<std::string, std::int32_t>, std::int64_t> samples;
};

/// Counts, event by event, what a log contains and what is lost in it.
class LogSurvey {
 public:
  static constexpr std::size_t kMaxStretches = 10'000;  ///< the last one holds all that follow

  void intact(const drivers::LogEvent& event);
  void damaged(const drivers::LogDamage& damage, bool truncated);

  std::int64_t events() const { return events_; }
  std::int64_t damaged_bytes() const;
  std::int64_t damaged_places() const;
  const std::vector<LostStretch>& lost() const { return lost_; }

 private:
  void count_samples(const drivers::LogEvent& event);

  /// The newest sequence number of a node, and the number of stretches before it.
  struct Node {
    std::int64_t sequence = 0;
    std::size_t stretches = 0;
  };
  std::map<std::pair<std::string, std::int32_t>, Node> nodes_;
  std::vector<LostStretch> lost_;
  std::int64_t events_ = 0, last_number_ = -1, last_us_ = 0;
  bool open_ = false;  ///< the newest stretch has no event after it yet
};

struct RepairArguments {
  std::string log;
  std::string out;     ///< empty: beside the log
  bool check = false;  ///< write nothing
  bool json = false;
};

/// Runs `framewatch repair`: copies the intact events of a log. Returns the exit code: 1 when
/// `check` finds damage, kBadInput when the log cannot be read or its copy cannot be written.
int repair(const RepairArguments& arguments);

}  // namespace framewatch::daemon
