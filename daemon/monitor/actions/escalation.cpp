// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/escalation.h"

#include <algorithm>

#include <fmt/core.h>

#include "daemon/base/log.h"
#include "daemon/monitor/actions/webhook_body.h"
#include "daemon/monitor/events/event_messages.h"

namespace framewatch::daemon {
namespace {

constexpr double kMinuteOfEscalation_us = 60e6;

}  // namespace

void Escalation::configure(std::size_t receivers, double after_min) {
  receivers_ = receivers;
  after_min_ = after_min;
}

std::size_t Escalation::event(const event_t& e, bool acknowledged, std::int64_t now_us) {
  const Key key{e.kind, e.id};
  if (is_momentary(e)) return 1;  // it cannot be acknowledged
  if (acknowledged || e.state == event_state::cleared) {
    open_.erase(key);
    return receivers_;
  }
  const auto found = open_.find(key);
  if (found != open_.end()) {
    found->second.event = e;
    return found->second.told;
  }
  if (receivers_ < 2) return receivers_;
  if (open_.size() >= kMax) {
    const auto oldest = std::min_element(open_.begin(), open_.end(), [](auto& a, auto& b) {
      return a.second.next_us < b.second.next_us;
    });
    log(LogLevel::error, fmt::format("too many open events: {} {} goes to no further receiver",
                                     oldest->first.first, oldest->second.event.place));
    open_.erase(oldest);
  }
  open_.emplace(
      key, Open{e, 1, now_us + static_cast<std::int64_t>(kMinuteOfEscalation_us * after_min_)});
  return 1;
}

void Escalation::acknowledged(const event_t& e) {
  open_.erase({e.kind, e.id});
}

std::vector<Escalation::Due> Escalation::due(int least_severity, std::int64_t now_us) {
  const auto pause_us = static_cast<std::int64_t>(kMinuteOfEscalation_us * after_min_);
  std::vector<Due> out;
  for (auto& [key, open] : open_) {
    if (open.event.severity < least_severity) {
      open.next_us = now_us + pause_us;
      continue;
    }
    if (open.told >= receivers_ || now_us < open.next_us) continue;
    event_t event = open.event;
    event.state = event_state::raised;
    event.message += fmt::format(" (not acknowledged for {:g} min)",
                                 after_min_ * static_cast<double>(open.told));
    out.push_back({open.told, std::move(event)});
    ++open.told;
    open.next_us = now_us + pause_us;
  }
  return out;
}

}  // namespace framewatch::daemon
