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

namespace lcm {
class LCM;
}

namespace framewatch::daemon {

/// Acknowledges events as requests (acknowledge_t) ask it to, and publishes what is acknowledged
/// (acknowledged_t) every second and after each request.
class AcknowledgeDesk {
 public:
  static constexpr std::size_t kMaxRequests = 16;  ///< of LCM that wait; a sender repeats its own
  using Done = std::function<void(const event_t&, const Acknowledgement&)>;
  /// The events that can be acknowledged.
  using Raised = std::vector<RaisedEvents*>;

  /// Both must outlive this. done: is called for each event that is acknowledged.
  AcknowledgeDesk(const Config& config, lcm::LCM& lcm, Done done);

  /// Obeys a request of this user. The answer has the events it is about, without comments, or the
  /// reason of a refusal; empty when these bytes are no request. now_us: host clock.
  std::optional<acknowledged_t> obey(std::span<const std::uint8_t> request, const std::string& user,
                                     const Raised& raised, std::int64_t now_us);

  /// A request that came over LCM, from nobody knows whom: look() obeys it where lcm.commands
  /// allows that; otherwise it is counted, and a log line says so.
  void heard(std::span<const std::uint8_t> request, std::int64_t now_us);
  std::int64_t not_obeyed() const { return not_obeyed_; }

  /// To be called several times a second.
  void look(const Raised& raised, std::int64_t now_us);

 private:
  void acknowledge(const acknowledge_t& request, const std::string& user, const Raised& raised,
                   std::int64_t now_us);

  const Config& config_;
  lcm::LCM& lcm_;
  Done done_;
  std::vector<acknowledge_t> requests_;  ///< of LCM
  std::int64_t not_obeyed_ = 0, answered_ = 0;
  RateLimitedLog warnings_{LogLevel::warning};
  OnceASecond second_;
  bool news_ = false;
  std::string refused_;
  std::optional<Acknowledgement> all_;  ///< of the newest request for every event
};

}  // namespace framewatch::daemon
