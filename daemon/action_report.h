#pragma once

#include <cstdint>
#include <optional>

#include <framewatch/action_status_t.hpp>
#include <lcm/lcm-cpp.hpp>

#include "daemon/action_way.h"
#include "daemon/config.h"
#include "daemon/once_a_second.h"
#include "daemon/raised_events.h"

namespace framewatch::daemon {

/// [actions] of a running estimation: a command and a webhook are told of events, and everybody how
/// that goes, action_status_t every second.
class ActionReport {
 public:
  /// Both must outlive this.
  ActionReport(const Config& config, lcm::LCM& lcm);

  /// The configuration was read anew.
  void reconfigure();
  /// What was raised before this began is known, its end is to be told.
  void raised_before(const RaisedEvents& raised);
  /// Never waits. acknowledged: somebody knows of it; only that it is over is told.
  void event(const event_t& event, bool acknowledged);
  /// Somebody knows of it now.
  void acknowledged(const event_t& event);
  /// Several times a second; now_us: of the host's clock.
  void look(std::int64_t now_us);

 private:
  action_status_t status(std::int64_t now_us) const;

  const Config& config_;
  lcm::LCM& lcm_;
  OnceASecond second_;
  std::optional<ActionWay> command_, webhook_;  ///< once there was one
};

}  // namespace framewatch::daemon
