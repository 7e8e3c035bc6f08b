// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include <framewatch/event_t.hpp>

#include "daemon/monitor/events/event_messages.h"

namespace framewatch::daemon {

/// The subject of an event, and since when it holds.
struct EventSubject {
  std::string kind, place;
  std::int64_t id;
  std::int64_t since_us;
};

constexpr std::int32_t raised_or_cleared(bool raised) {
  return raised ? event_state::raised : event_state::cleared;
}

/// Returns an event without value, unit and message: a warning, or information when it is cleared.
/// state: of event_state.
event_t warning_event(const EventSubject& subject, std::int32_t state, std::int64_t time_us);

}  // namespace framewatch::daemon
