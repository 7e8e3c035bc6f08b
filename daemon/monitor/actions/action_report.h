// SPDX-License-Identifier: MIT
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

/// The [actions] of a running estimation: delivers events to a command and a webhook, and publishes
/// the state of the deliveries every second (action_status_t).
class ActionReport {
 public:
  /// `lcm` must outlive this.
  ActionReport(const Config& config, lcm::LCM& lcm);

  /// Continues with another configuration, of which [actions] may differ.
  void reconfigure(const Config& config);
  /// Tells which events an earlier run has delivered: only their end is delivered.
  void raised_before(const RaisedEvents& raised);
  /// Queues an event; never waits. Of an `acknowledged` event only the end is delivered.
  void event(const event_t& event, bool acknowledged);
  /// Tells that the event was acknowledged now.
  void acknowledged(const event_t& event);
  /// Publishes the state once a second. Call it several times a second; `now_us`: host clock.
  void update(std::int64_t now_us);

 private:
  action_status_t status(std::int64_t now_us) const;

  std::optional<ActionSettings> settings_;  ///< empty: without [actions]
  std::string building_, prefix_;
  lcm::LCM& lcm_;
  OnceASecond second_;
  std::optional<Notifier> command_, webhook_;  ///< empty until one is configured
};

}  // namespace framewatch::daemon
