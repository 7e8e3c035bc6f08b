// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace framewatch::fleet {

/// The required configuration of a stream of the hub, or of a consumer of a stream.
struct HubPart {
  std::string stream;
  std::string consumer;  ///< empty: the stream itself
  std::string config;    ///< JSON of the JetStream API: the values to check
};

/// Returns the streams and consumers of a hub (docs/fleet.md), each stream before its consumers.
/// buildings: number of buildings that the sizes are for.
std::vector<HubPart> hub_parts(int replicas, int buildings);

/// Sends a request to the hub. Returns nullopt and sets `error` when nothing answers.
using AskHub = std::function<std::optional<std::string>(
    const std::string& subject, const std::string& json, std::string& error)>;

/// The result of setting up one hub.
struct SetupOutcome {
  std::vector<std::string> lines;  ///< one for each part: "FW_EVENT: correct", ...
  std::vector<std::string> problems;
  int changed = 0;  ///< parts that were created or changed, or would be with only_look
};

/// Creates missing parts, changes parts that differ, and lists every difference. only_look: lists
/// differences and changes nothing.
SetupOutcome set_up(const std::vector<HubPart>& parts, const AskHub& ask, bool only_look);

}  // namespace framewatch::fleet
