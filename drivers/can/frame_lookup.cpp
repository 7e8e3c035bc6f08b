#include "drivers/can/frame_lookup.h"

#include <algorithm>

namespace framewatch::drivers {

FrameLookup::FrameLookup(const CanMap& map, int bus) {
  for (std::size_t n = 0; n < map.nodes.size(); ++n) {
    if (map.nodes[n].bus != bus) continue;
    for (std::size_t m = 0; m < map.nodes[n].messages.size(); ++m) {
      const CanMessageMap& message = map.nodes[n].messages[m];
      auto at = std::find_if(groups_.begin(), groups_.end(), [&](const Group& g) {
        return g.mask == message.mask && g.extended == message.extended;
      });
      if (at == groups_.end()) at = groups_.insert(at, Group{message.mask, message.extended, {}});
      at->targets[message.id & message.mask].push_back({static_cast<int>(n), static_cast<int>(m)});
    }
  }
}

const std::vector<FrameLookup::Target>& FrameLookup::find(std::uint32_t id, bool extended) const {
  static const std::vector<Target> kNone;
  for (const Group& group : groups_) {
    if (group.extended != extended) continue;
    const auto at = group.targets.find(id & group.mask);
    if (at != group.targets.end()) return at->second;
  }
  return kNone;
}

}  // namespace framewatch::drivers
