#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>
#include <lcm/lcm-cpp.hpp>

#include "daemon/config.h"
#include "daemon/once_a_second.h"
#include "daemon/raised_events.h"

namespace framewatch::daemon {

/// That one event is acknowledged.
acknowledged_t one_acknowledged(const event_t& event, const Acknowledgement& by);

/// Where events are acknowledged: takes acknowledge_t from LCM, and says what is acknowledged,
/// acknowledged_t every second and after each request.
class AcknowledgeDesk {
 public:
  static constexpr std::size_t kMostRequests = 16;  ///< that wait; a sender sends again
  using Done = std::function<void(const event_t&, const Acknowledgement&)>;

  /// Both must outlive this. Requests arrive while somebody handles LCM's messages.
  AcknowledgeDesk(const Config& config, lcm::LCM& lcm);
  ~AcknowledgeDesk();
  AcknowledgeDesk(const AcknowledgeDesk&) = delete;
  AcknowledgeDesk& operator=(const AcknowledgeDesk&) = delete;

  /// Several times a second; now_us: of the host's clock. raised: what can be acknowledged. done:
  /// hears of each event that is.
  void look(const std::vector<RaisedEvents*>& raised, const Done& done, std::int64_t now_us);

 private:
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void obey(const acknowledge_t& request, const std::vector<RaisedEvents*>& raised,
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
