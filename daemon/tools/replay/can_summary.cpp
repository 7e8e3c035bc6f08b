#include "daemon/tools/replay/can_summary.h"

#include <fmt/core.h>

#include "daemon/base/json.h"

namespace framewatch::daemon {

std::string can_text(const drivers::CanIntake& can) {
  if (can.map().empty()) return {};
  std::string out;
  for (std::size_t b = 0; b < can.buses().size(); ++b) {
    const drivers::CanBusCounters& bus = can.buses()[b];
    out += fmt::format("{}: {} frames, {} of other devices, {} SYNC, {} error frames\n",
                       can.map().buses[b].interface, bus.frames, bus.foreign, bus.syncs,
                       bus.error_frames);
  }
  out +=
      fmt::format("{:<14} {:>9} {:>9} {:>7} {:>6} {:>6} {:>9} {:>7} {:>9}\n", "CAN node", "rate_Hz",
                  "received", "lost", "late", "twice", "reordered", "no time", "malformed");
  for (std::size_t n = 0; n < can.map().nodes.size(); ++n) {
    const drivers::CanNodeCounters c = can.node(n);
    out += fmt::format("{:<14} {:>9.4f} {:>9} {:>7} {:>6} {:>6} {:>9} {:>7} {:>9}\n",
                       can.map().nodes[n].name, c.rate_hz(), c.received, c.lost, c.late,
                       c.duplicates, c.reordered, c.unplaced, c.wrong_length + c.wrong_kind);
    for (const drivers::CanMessageMap& m : can.map().nodes[n].messages)
      for (const drivers::CanReading& r : m.readings) {
        if (r.sample > 0) continue;
        const drivers::CanRange& range = can.range_of(static_cast<std::size_t>(r.axis));
        out += fmt::format("  {}.{}: {} values from {:g} to {:g}\n", m.name, r.name, range.count,
                           range.least, range.most);
      }
  }
  return out + "\n";
}

std::string can_json(const drivers::CanIntake& can) {
  if (can.map().empty()) return {};
  std::string out = "\"can_nodes\": [";
  for (std::size_t n = 0; n < can.map().nodes.size(); ++n) {
    const drivers::CanNodeCounters c = can.node(n);
    out += fmt::format(
        "{}\n  {{\"name\": {}, \"rate_hz\": {}, \"received\": {}, \"lost\": {}, \"late\": {}, "
        "\"duplicates\": {}, \"reordered\": {}, \"unplaced\": {}, \"malformed\": {}}}",
        n == 0 ? "" : ",", json_text(can.map().nodes[n].name), json_number(c.rate_hz()), c.received,
        c.lost, c.late, c.duplicates, c.reordered, c.unplaced, c.wrong_length + c.wrong_kind);
  }
  out += "],\n \"can_buses\": [";
  for (std::size_t b = 0; b < can.buses().size(); ++b) {
    const drivers::CanBusCounters& bus = can.buses()[b];
    out += fmt::format(
        "{}\n  {{\"interface\": {}, \"frames\": {}, \"foreign\": {}, \"syncs\": {}, "
        "\"error_frames\": {}}}",
        b == 0 ? "" : ",", json_text(can.map().buses[b].interface), bus.frames, bus.foreign,
        bus.syncs, bus.error_frames);
  }
  return out + "],\n ";
}

}  // namespace framewatch::daemon
