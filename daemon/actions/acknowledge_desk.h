#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <framewatch/acknowledge_t.hpp>

#include "daemon/base/once_a_second.h"
#include "daemon/config/config.h"
#include "daemon/events/raised_events.h"

namespace lcm {
class LCM;
class Subscription;
struct ReceiveBuffer;
}  // namespace lcm

namespace framewatch::daemon {

/// Acknowledges events: receives requests (acknowledge_t) over LCM and publishes what is
/// acknowledged (acknowledged_t) every second and after each request.
class AcknowledgeDesk {
 public:
  static constexpr std::size_t kMostRequests = 16;  ///< in the queue; a sender repeats its request
  using Done = std::function<void(const event_t&, const Acknowledgement&)>;

  /// Both must outlive this. Requests arrive while LCM's messages are handled.
  AcknowledgeDesk(const Config& config, lcm::LCM& lcm);
  ~AcknowledgeDesk();
  AcknowledgeDesk(const AcknowledgeDesk&) = delete;
  AcknowledgeDesk& operator=(const AcknowledgeDesk&) = delete;

  /// To be called several times a second. raised: the events that can be acknowledged. done: is
  /// called for each event that is acknowledged. now_us: host clock.
  void look(const std::vector<RaisedEvents*>& raised, const Done& done, std::int64_t now_us);

 private:
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void answer(const acknowledge_t& request, const std::vector<RaisedEvents*>& raised,
              const Done& done);

  const Config& config_;
  lcm::LCM& lcm_;
  lcm::Subscription* subscription_;
  std::vector<acknowledge_t> requests_;
  std::int64_t answered_ = 0;
  OnceASecond second_;
  std::string refused_;
};

}  // namespace framewatch::daemon
