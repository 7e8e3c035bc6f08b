// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace framewatch::daemon {

/// Keys of [[can_node]] about its sender's messages. The other keys are in drivers::CanNodeMap.
struct CanNodeSettings {
  std::vector<std::string> messages;
  std::uint32_t id_offset = 0;  ///< added to the ids of the DBC
  bool j1939 = false;
  int source_address = -1;  ///< J1939; -1: any
};

}  // namespace framewatch::daemon
