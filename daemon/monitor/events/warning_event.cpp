// SPDX-License-Identifier: MIT
#include "daemon/monitor/events/warning_event.h"

#include "estimator/numeric/nan.h"

namespace framewatch::daemon {

event_t warning_event(const EventSubject& subject, std::int32_t state, std::int64_t time_us) {
  event_t m{};
  m.time_us = time_us;
  m.since_us = subject.since_us;
  m.id = subject.id;
  m.state = state;
  m.severity = state == event_state::cleared ? severity::information : severity::warning;
  m.kind = subject.kind;
  m.place = subject.place;
  m.std_error = estimator::kNaN;
  return m;
}

}  // namespace framewatch::daemon
