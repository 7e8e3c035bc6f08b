// SPDX-License-Identifier: MIT
#include "daemon/monitor/events/event_messages.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/json.h"
#include "daemon/base/printable.h"
#include "daemon/base/process.h"
#include "daemon/base/utc_time.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxSaid = 100;  // bytes of a stated name

}  // namespace

std::string event_json(const event_t& e, const std::string& building) {
  const Json out{{"schema", "framewatch.event/1"},
                 {"news", fmt::format("{}/{}/{}/{}", e.kind, e.id, e.time_us, e.state)},
                 {"building", building},
                 {"id", e.id},
                 {"state", word(kEventStates, e.state)},
                 {"severity", word(kSeverities, e.severity)},
                 {"kind", e.kind},
                 {"place", e.place},
                 {"message", e.message},
                 {"value", json_value(e.value)},
                 {"std_error", json_value(e.std_error)},
                 {"unit", e.unit},
                 {"segment", e.segment},
                 {"time", utc_text(e.time_us)},
                 {"time_us", e.time_us},
                 {"since", utc_text(e.since_us)},
                 {"since_us", e.since_us}};
  return json_line(out);
}

acknowledge_t acknowledge_request(std::int64_t id, const std::string& who,
                                  const std::string& comment) {
  acknowledge_t out{};
  out.request = random_id();
  out.time_us = host_clock_us();
  out.id = id;
  out.who = who;
  out.comment = comment;
  return out;
}

std::string who_text(const std::string& user, const std::string& says) {
  if (says.empty()) return user;
  return fmt::format("{} (says: {})", user, printable(says, kMaxSaid));
}

void add_acknowledged(acknowledged_t& message, const event_t& event, const Acknowledgement& by) {
  message.id.push_back(event.id);
  message.kind.push_back(event.kind);
  message.place.push_back(event.place);
  message.since_us.push_back(by.time_us);
  message.who.push_back(by.who);
  message.comment.push_back(by.comment);
  message.events = static_cast<std::int32_t>(message.id.size());
}

void add_all_acknowledged(acknowledged_t& message, const Acknowledgement& by) {
  event_t all{};
  all.id = kAllEvents;
  add_acknowledged(message, all, by);
}

}  // namespace framewatch::daemon
