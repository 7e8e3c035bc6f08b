// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/quiet_hours.h"

#include "daemon/monitor/events/event_messages.h"

namespace framewatch::daemon {

QuietHours::QuietHours(const ActionSettings& s)
    : span_(read_daily_span(s.quiet_hours)),
      zone_(TimeZone::find(s.time_zone)),
      severity_(s.quiet_severity) {}

int QuietHours::least_severity(std::int64_t now_us) const {
  const bool quiet = span_ && zone_ && span_->holds(zone_->minute_of_day(now_us));
  return quiet ? severity_ : severity::information;
}

}  // namespace framewatch::daemon
