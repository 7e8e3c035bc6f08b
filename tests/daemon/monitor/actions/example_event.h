// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>

#include <framewatch/event_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/monitor/events/event_messages.h"

namespace framewatch::daemon {

inline event_t event(std::int64_t id, int state = event_state::raised,
                     int severity = severity::alarm) {
  event_t e{};
  e.id = id;
  e.time_us = 1'700'000'000 * kSecond_us + id;
  e.since_us = e.time_us - kSecond_us;
  e.state = state;
  e.severity = severity;
  e.kind = "stiffness_change";
  e.place = "kx_1_y1";
  e.value = -5.25;
  e.std_error = std::numeric_limits<double>::quiet_NaN();
  e.unit = "%";
  e.message = "kx_1_y1 is 5.2 % below its \"baseline\"";
  return e;
}

inline bool never() {
  return false;
}

inline double seconds_for(const std::function<void()>& work) {
  const std::int64_t began_us = steady_clock_us();
  work();
  return 1e-6 * static_cast<double>(steady_clock_us() - began_us);
}

}  // namespace framewatch::daemon
