// SPDX-License-Identifier: MIT
#include "fleet/worker/automation.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <framewatch/service_t.hpp>

#include "daemon/monitor/events/event_messages.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::fleet {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxRaised = 100;

Message message(const std::string& building, const char* what, const std::string& text) {
  return {fmt::format("framewatch.{}.{}", building, what), "", {}, {text.begin(), text.end()}};
}

/// Lists kMaxRaised events, most severe first, and counts the others.
std::string state_json(const std::string& building, const service_t& s) {
  std::vector<std::size_t> order(s.event_id.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return s.event_severity[a] > s.event_severity[b];
  });
  json raised = json::array();
  for (std::size_t n = 0; n < std::min(order.size(), kMaxRaised); ++n) {
    const std::size_t i = order[n];
    raised.push_back({{"id", s.event_id[i]},
                      {"since_us", s.event_since_us[i]},
                      {"severity", daemon::word(daemon::kSeverities, s.event_severity[i])},
                      {"kind", s.event_kind[i]},
                      {"place", s.event_place[i]},
                      {"message", s.event_message[i]}});
  }
  const char* const worst =
      order.empty() ? "none" : daemon::word(daemon::kSeverities, s.event_severity[order.front()]);
  return json{{"schema", "framewatch.state/1"}, {"building", building},
              {"time_us", s.time_us},           {"severity", worst},
              {"raised_count", order.size()},   {"raised", raised}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

std::vector<Message> automation_messages(const FleetBatch& batch) {
  std::vector<Message> out;
  for (const ReceivedEvent& e : batch.events)
    out.push_back(message(e.building, "event", daemon::event_json(e.event, e.building)));
  std::map<std::string, service_t> newest;
  for (const ReceivedNewest& n : batch.newest)
    if (n.kind == "service")
      if (auto service = drivers::decoded<service_t>(n.content))
        newest[n.building] = std::move(*service);
  for (const auto& [building, service] : newest)
    out.push_back(message(building, "state", state_json(building, service)));
  return out;
}

}  // namespace framewatch::fleet
