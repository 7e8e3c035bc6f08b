#pragma once

#include <cstdint>
#include <optional>

#include <framewatch/event_t.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/events/raised_events.h"
#include "drivers/lcm/accel_intake.h"

namespace framewatch::daemon {

/// Trouble with a node's messages as an event: two_senders, sequence_leap, duplicates, losses, and
/// channel_table for a table that contradicts the configuration. The place is the channel, of a
/// node the first one it carries; the id depends on kind and place alone, and is larger than the
/// ids of alarms and of CAN. Empty when it is over and not among the `raised`.
std::optional<event_t> intake_event(const drivers::IntakeNotice& notice, const Config& config,
                                    const RaisedEvents& raised, std::int64_t now_us);

}  // namespace framewatch::daemon
