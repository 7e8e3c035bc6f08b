#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/action_status_t.hpp>
#include <framewatch/can_status_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/history_status_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/watch_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/config.h"

namespace framewatch::daemon {

/// What was heard of a daemon while somebody listened to it for a few seconds.
class Heard {
 public:
  explicit Heard(const Config& config) : prefix_(config.lcm.prefix) {}

  std::vector<std::string> channels() const;
  void message(const std::string& channel, const void* data, std::size_t size);

  /// Two reports of the process, and two of the samples unless none come: more would not say more.
  bool enough() const;

  std::optional<service_t> first_service, service;
  std::optional<status_t> first_status, status;
  std::optional<window_estimate_t> estimate;
  std::optional<gap_t> gap;
  std::optional<watch_t> watch;
  std::optional<can_status_t> can;
  std::optional<history_status_t> history;
  std::optional<action_status_t> actions;
  std::optional<acknowledged_t> acknowledged;

 private:
  std::string prefix_;
};

/// Which of heard.acknowledged is of this event; empty when nobody has acknowledged it.
std::optional<std::size_t> acknowledgement_of(const Heard& heard, std::int64_t event_id);

/// Everything that is not as it should be, a sentence each, and that nobody has acknowledged;
/// nothing when it is well. heard.service
/// is there. now_us: host clock.
std::vector<std::string> oddities(const Heard& heard, const Config& config, std::int64_t now_us);

/// Since the newest sample came; none has come: since the start.
double silent_s(const service_t& service, std::int64_t now_us);

/// "3 d 4 h", "5 min 10 s", "2 s".
std::string span_text(double seconds);

}  // namespace framewatch::daemon
