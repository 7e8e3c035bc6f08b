#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "drivers/can/can_map.h"

namespace framewatch::drivers {

/// Finds the configured messages that a frame with this id can be (several when multiplexed).
/// Memory is bounded by the map, whatever ids arrive.
class FrameLookup {
 public:
  struct Target {
    int node, message;  ///< of the map
  };

  FrameLookup(const CanMap& map, int bus);

  /// Empty for ids that no node has.
  const std::vector<Target>& find(std::uint32_t id, bool extended) const;

 private:
  struct Group {
    std::uint32_t mask;
    bool extended;
    std::unordered_map<std::uint32_t, std::vector<Target>> targets;
  };
  std::vector<Group> groups_;
};

}  // namespace framewatch::drivers
