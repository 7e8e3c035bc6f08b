// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/reception_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/status_t.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/service/latest_messages.h"

namespace framewatch::daemon {

/// The latest messages of a daemon that `framewatch status` collects over a few seconds, and the
/// first report of each kind that counts something.
class Heard : public LatestMessages {
 public:
  explicit Heard(const Config& config) : LatestMessages(config.lcm.prefix) {}

  /// Returns the LCM channels to listen on.
  std::vector<std::string> channels() const;
  /// Takes one LCM message. Ignores other channels and malformed payloads.
  void message(const std::string& channel, const void* data, std::size_t size);

  /// Returns true when two reports of the process have come, and two of the samples unless no
  /// samples arrive.
  bool enough() const;

  /// Set when the second report of the kind comes.
  std::optional<service_t> first_service;
  std::optional<status_t> first_status;
  std::optional<reception_t> first_reception;
};

/// Returns the index of the event in `acknowledged`; nullopt if it is not acknowledged.
std::optional<std::size_t> acknowledgement_of(const std::optional<acknowledged_t>& acknowledged,
                                              std::int64_t event_id);

/// Returns the raised event at index `at` of a service report, which has no numbers of it.
event_t raised_event(const service_t& service, std::size_t at);

/// Returns every problem that is not acknowledged, one sentence each; empty if the daemon is
/// healthy. Requires heard.service. `now_us`: host clock. `words` turns an event into a sentence
/// for people.
std::vector<std::string> oddities(const Heard& heard, const Config& config, std::int64_t now_us,
                                  const std::function<std::string(const event_t&)>& words);

/// Returns the time since the newest sample, or since the start if no sample has come.
double silent_s(const service_t& service, std::int64_t now_us);

std::int64_t total(const std::vector<std::int64_t>& counters);

/// Returns a duration such as "3 d 4 h", "5 min 10 s" or "2 s".
std::string span_text(double seconds);

}  // namespace framewatch::daemon
