// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/action_status_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/config/config.h"
#include "daemon/monitor/actions/daily_well.h"
#include "daemon/monitor/actions/escalation.h"
#include "daemon/monitor/actions/event_picture.h"
#include "daemon/monitor/actions/monthly_reports.h"
#include "daemon/monitor/actions/notifier.h"
#include "daemon/monitor/actions/quiet_hours.h"
#include "daemon/monitor/events/raised_events.h"

namespace lcm {
class LCM;
}

namespace framewatch::daemon {

/// The [actions] and the [report] of a running estimation: delivers events to a command, a webhook
/// and by e-mail, and publishes the state of the deliveries every second (action_status_t).
class ActionReport {
 public:
  /// `lcm`, where the program publishes on `url`, must outlive this. An empty `url` is that of the
  /// configuration.
  ActionReport(const Config& config, const std::string& url, lcm::LCM& lcm);

  /// Continues with another configuration, of which [actions] may differ.
  void reconfigure(const Config& config);
  /// Tells which events an earlier run has delivered: only their end is delivered. The time until
  /// they escalate begins anew.
  void raised_before(const RaisedEvents& raised);
  /// Queues an event; never waits. Of an `acknowledged` event only the end is delivered.
  void event(const event_t& event, bool acknowledged);
  /// Tells that the event was acknowledged now.
  void acknowledged(const event_t& event);
  /// Escalates events that are not acknowledged, sends the daily message, starts the
  /// monthly report, and publishes the state once a second. Call it several times a second;
  /// `now_us`: host clock.
  void update(std::int64_t now_us);

 private:
  /// A way to tell people.
  struct Receiver {
    const char* name;
    Notifier::Deliver deliver;
    double (*patience_s)(const ActionSettings&);
    std::unique_ptr<Notifier> notifier = {};  ///< null until the receiver is used
  };

  bool tells(const Receiver& receiver) const {
    return settings_ && receiver.notifier && settings_->has(receiver.name);
  }
  /// Returns the place in the order of escalation; 0 for a receiver that is not listed.
  std::size_t place_of(const Receiver& receiver) const;
  void escalate();
  void tell_well(const event_t& event);
  action_status_t status(std::int64_t now_us) const;

  std::optional<ActionSettings> settings_;  ///< empty: without [actions]
  std::string building_, prefix_;
  lcm::LCM& lcm_;
  OnceASecond second_;
  const EventSources sources_;
  const std::string url_;
  Escalation escalation_;
  QuietHours quiet_;
  DailyWell well_;
  MonthlyReports months_;
  std::vector<Receiver> receivers_;
};

}  // namespace framewatch::daemon
