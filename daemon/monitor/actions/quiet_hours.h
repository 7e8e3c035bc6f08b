// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "daemon/base/local_time.h"
#include "daemon/config/keys/action_options.h"

namespace framewatch::daemon {

/// The hours of [actions] in which only severe events are delivered.
class QuietHours {
 public:
  /// Without quiet hours.
  QuietHours() = default;
  /// Settings that the configuration would refuse have no quiet hours.
  explicit QuietHours(const ActionSettings& settings);

  /// Returns the lowest event_t::severity that is delivered at a time of the host's clock.
  int least_severity(std::int64_t now_us) const;

 private:
  std::optional<DailySpan> span_;
  std::optional<TimeZone> zone_;
  int severity_ = 0;
};

}  // namespace framewatch::daemon
