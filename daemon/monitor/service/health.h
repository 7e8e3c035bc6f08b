#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/action_status_t.hpp>
#include <framewatch/can_status_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/history_status_t.hpp>
#include <framewatch/reception_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/uplink_status_t.hpp>
#include <framewatch/watch_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/config/config.h"

namespace framewatch::daemon {

/// The newest messages of a daemon, collected over a few seconds.
class Heard {
 public:
  explicit Heard(const Config& config) : prefix_(config.lcm.prefix) {}

  std::vector<std::string> channels() const;
  void message(const std::string& channel, const void* data, std::size_t size);

  /// Whether two reports of the process have come, and two of the samples unless there are none.
  bool enough() const;

  std::optional<service_t> first_service, service;
  std::optional<status_t> first_status, status;
  std::optional<window_estimate_t> estimate;
  std::optional<gap_t> gap;
  std::optional<watch_t> watch;
  std::optional<can_status_t> can;
  std::optional<history_status_t> history;
  std::optional<action_status_t> actions;
  std::optional<reception_t> first_reception, reception;
  std::optional<acknowledged_t> acknowledged;
  std::optional<uplink_status_t> uplink;

 private:
  std::string prefix_;
};

/// Returns the index of the event in heard.acknowledged; nullopt if it is not acknowledged.
std::optional<std::size_t> acknowledgement_of(const Heard& heard, std::int64_t event_id);

/// Returns the raised event at index `at` of a service report, which has no numbers of it.
event_t raised_event(const service_t& service, std::size_t at);

/// Returns every problem that is not acknowledged, one sentence each; empty if the daemon is
/// healthy. Requires heard.service. `now_us`: host clock. `words` turns an event into a sentence
/// for people.
std::vector<std::string> oddities(const Heard& heard, const Config& config, std::int64_t now_us,
                                  const std::function<std::string(const event_t&)>& words);

/// Returns the time since the newest sample, or since the start if no sample has come.
double silent_s(const service_t& service, std::int64_t now_us);

/// Returns a duration such as "3 d 4 h", "5 min 10 s" or "2 s".
std::string span_text(double seconds);

}  // namespace framewatch::daemon
