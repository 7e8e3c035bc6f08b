#include "daemon/monitor/estimation/can_events.h"

#include <algorithm>
#include <string>

#include <fmt/core.h>

#include "daemon/monitor/events/event_words.h"

namespace framewatch::daemon {
namespace {

using Kind = drivers::CanNotice::Kind;

constexpr std::int64_t kFirstId = std::int64_t{1} << 40;
constexpr std::size_t kKinds = 7;

const char* name_of(Kind kind) {
  switch (kind) {
    case Kind::bus_off:
      return "bus_off";
    case Kind::interface_gone:
      return "interface_gone";
    case Kind::emergency:
      return "emergency";
    case Kind::boot_up:
      return "boot_up";
    case Kind::sequence_leap:
      return "sequence_leap";
    case Kind::duplicates:
      return "duplicates";
    case Kind::losses:
      return "losses";
  }
  return "";
}

std::string message_of(Kind kind, const std::string& place, bool over, int code) {
  switch (kind) {
    case Kind::bus_off:
      return place + (over ? ": is on the bus again" : ": bus-off, nothing is received");
    case Kind::interface_gone:
      return place + (over ? ": is there again" : ": is down or gone, waiting for it");
    case Kind::emergency:
      return over ? place + ": no emergency any more"
                  : fmt::format("{}: CANopen emergency {:04X}h", place, code);
    case Kind::boot_up:
      return place + ": has booted";
    case Kind::sequence_leap:
      return place + (over ? ": its numbers go on without leaps"
                           : ": its numbers leapt: it began anew, or another node has its ids");
    case Kind::duplicates:
      return over ? place + ": its messages come once again"
                  : fmt::format("{}: {} messages came twice within 10 s", place, code);
    case Kind::losses:
      return over ? place + ": its messages come again"
                  : fmt::format("{}: {} messages were lost within 10 s", place, code);
  }
  return place;
}

}  // namespace

CanEvents::CanEvents(const drivers::CanMap& map)
    : map_(map), begun_(kKinds * std::max(map.buses.size(), map.nodes.size())) {}

std::optional<event_t> CanEvents::of(const drivers::CanNotice& n) {
  const std::size_t width = begun_.size() / kKinds;
  const auto index = static_cast<std::size_t>(n.index);
  const std::size_t at = static_cast<std::size_t>(n.kind) * width + index;
  const bool of_bus = n.kind == Kind::bus_off || n.kind == Kind::interface_gone;
  const std::string& place = of_bus ? map_.buses[index].interface : map_.nodes[index].name;
  Begun& begun = begun_[at];
  const bool momentary = n.kind == Kind::boot_up;
  if (!momentary && begun.on == !n.over && (n.over || begun.code == n.code)) return std::nullopt;
  event_t m{};
  m.time_us = n.time_us;
  m.state = momentary || n.over ? event_state::cleared
            : begun.on          ? event_state::changed
                                : event_state::raised;
  if (!begun.on) begun.since_us = n.time_us;
  begun.on = !momentary && !n.over;
  begun.code = n.code;
  m.since_us = begun.since_us;
  m.id = kFirstId + static_cast<std::int64_t>(at);
  const bool of_numbers = n.kind >= Kind::sequence_leap;
  m.severity = momentary || (of_numbers && n.over) ? severity::information
               : of_numbers || n.over              ? severity::warning
                                                   : severity::alarm;
  m.kind = name_of(n.kind);
  m.place = place;
  m.value = n.code;
  m.message = message_of(n.kind, place, n.over, n.code);
  return m;
}

}  // namespace framewatch::daemon
