#include "fleet/worker/flood_gate.h"

#include <utility>

#include "daemon/base/clocks.h"

namespace framewatch::fleet {

bool FloodGate::takes(const std::string& building, std::size_t bytes, std::int64_t hub_us) {
  const std::int64_t hour_us = hub_us - hub_us % (3600 * daemon::kSecond_us);
  if (hour_us != hour_us_) {
    floods_ = take_floods();
    said_.clear();
    hour_us_ = hour_us;
  }
  Said& said = said_[building];
  const auto size = static_cast<std::int64_t>(bytes);
  if (said.messages < most_messages_ && said.bytes + size <= most_bytes_) {
    ++said.messages;
    said.bytes += size;
    return true;
  }
  ++said.flood_messages;
  said.flood_bytes += size;
  return false;
}

std::vector<ReceivedFlood> FloodGate::take_floods() {
  std::vector<ReceivedFlood> out = std::exchange(floods_, {});
  for (auto& [building, said] : said_) {
    if (said.flood_messages == 0) continue;
    out.push_back({building, hour_us_, std::exchange(said.flood_messages, 0),
                   std::exchange(said.flood_bytes, 0)});
  }
  return out;
}

}  // namespace framewatch::fleet
