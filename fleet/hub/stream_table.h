#pragma once

#include <string>
#include <vector>

namespace framewatch::fleet {

/// A stream of the hub, or a consumer of one, as it should be.
struct HubPart {
  std::string stream;
  std::string consumer;  ///< empty: the stream itself
  std::string config;    ///< JSON of the JetStream API: every value that matters
};

/// What the hub consists of (docs/fleet.md), each stream before its consumers. Sizes are for so
/// many buildings.
std::vector<HubPart> hub_parts(int replicas, int buildings);

}  // namespace framewatch::fleet
