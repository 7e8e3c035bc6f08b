#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <framewatch/action_status_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/config/config.h"
#include "daemon/monitor/actions/notifier.h"
#include "daemon/monitor/events/raised_events.h"

namespace lcm {
class LCM;
}

namespace framewatch::daemon {

/// [actions] of a running estimation: delivers events to a command and a webhook, and publishes
/// every second how that goes (action_status_t).
class ActionReport {
 public:
  /// `lcm` must outlive this.
  ActionReport(const Config& config, lcm::LCM& lcm);

  /// Goes on with another configuration, of which [actions] may differ.
  void reconfigure(const Config& config);
  /// Events that an earlier run has delivered: only their end is delivered.
  void raised_before(const RaisedEvents& raised);
  /// Never waits. acknowledged: only the end of the event is delivered.
  void event(const event_t& event, bool acknowledged);
  /// The event is acknowledged now.
  void acknowledged(const event_t& event);
  /// To be called several times a second; now_us: host clock.
  void look(std::int64_t now_us);

 private:
  action_status_t status(std::int64_t now_us) const;

  std::optional<ActionSettings> settings_;  ///< none: nobody is notified
  std::string building_, prefix_;
  lcm::LCM& lcm_;
  OnceASecond second_;
  std::optional<Notifier> command_, webhook_;  ///< empty until one is configured
};

}  // namespace framewatch::daemon
