// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/config/config.h"
#include "daemon/monitor/events/raised_events.h"
#include "daemon/monitor/service/command_client.h"
#include "daemon/monitor/service/service_manager.h"

namespace lcm {
class LCM;
}

namespace framewatch::daemon {

/// Acknowledges events on request (acknowledge_t) and publishes the acknowledged events
/// (acknowledged_t) every second and after each request.
class AcknowledgeDesk {
 public:
  static constexpr std::size_t kMaxRequests = 16;  ///< waiting LCM requests; senders repeat theirs
  using Done = std::function<void(const event_t&, const Acknowledgement&)>;
  /// The sets of events that can be acknowledged.
  using Raised = std::vector<RaisedEvents*>;

  /// `config` and `lcm` must outlive this. Calls `done` for each event that is acknowledged.
  AcknowledgeDesk(const Config& config, lcm::LCM& lcm, Done done);

  /// Executes a request of this user. The answer holds the acknowledged events without their
  /// comments, or the reason of a refusal. Returns nullopt if the bytes are not a request.
  /// `now_us`: host clock.
  std::optional<acknowledged_t> obey(std::span<const std::uint8_t> request, const std::string& user,
                                     const Raised& raised, std::int64_t now_us);

  /// Takes a request that came over LCM, so its user is unknown. update() executes it if
  /// lcm.commands allows that; otherwise it is counted and logged.
  void heard(std::span<const std::uint8_t> request, std::int64_t now_us);
  /// Returns how many requests over LCM were ignored.
  std::int64_t not_obeyed() const { return not_obeyed_; }

  /// Executes waiting requests and publishes. Call it several times a second.
  void update(const Raised& raised, std::int64_t now_us);

 private:
  void acknowledge(const acknowledge_t& request, const std::string& user, const Raised& raised,
                   std::int64_t now_us);

  const Config& config_;
  lcm::LCM& lcm_;
  Done done_;
  std::vector<acknowledge_t> requests_;  ///< from LCM
  std::int64_t not_obeyed_ = 0, answered_ = 0;
  RateLimitedLog warnings_{LogLevel::warning};
  OnceASecond second_;
  bool news_ = false;
  std::string refused_;
  std::optional<Acknowledgement> all_;  ///< by the newest request for all events
};

struct RefusedCommand {
  int exit_code = 0;  ///< 1: the daemon refuses; 2: it does not answer, or not readably
  std::string why;
};

/// Gives the running daemon a command that it answers with an acknowledged_t. Returns nullopt and
/// sets `refused` if it does not obey.
std::optional<acknowledged_t> ask_daemon(const Config& config, const CommandPacket& command,
                                         RefusedCommand& refused);

struct AcknowledgeArguments {
  std::string event;  ///< number of the event, or "all"
  std::string config = kInstalledConfig;
  std::string who;  ///< a name beside the user's name, which the daemon knows; empty: not given
  std::string comment;
};

/// Runs `framewatch acknowledge`: asks the running daemon over its socket to acknowledge an event.
/// Returns the exit code: 1 when the event is not raised, 2 without an answer or with an invalid
/// configuration.
int acknowledge_command(const AcknowledgeArguments& arguments);

}  // namespace framewatch::daemon
