#pragma once

#include <functional>
#include <optional>
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

/// Asks the hub; empty, with the reason, when nothing answers.
using AskHub = std::function<std::optional<std::string>(
    const std::string& subject, const std::string& json, std::string& error)>;

/// What came of setting up one hub.
struct SetupOutcome {
  std::vector<std::string> lines;  ///< one for each part: "FW_EVENT: as it should be", ...
  std::vector<std::string> problems;
  int changed = 0;  ///< parts that were made or changed, or would be
};

/// Makes what is missing and changes what differs, each difference said. only_look: says it, and
/// changes nothing.
SetupOutcome set_up(const std::vector<HubPart>& parts, const AskHub& ask, bool only_look);

}  // namespace framewatch::fleet
