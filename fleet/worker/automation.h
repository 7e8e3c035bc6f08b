// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "fleet/message/message.h"
#include "fleet/store/fleet_store.h"

namespace framewatch::fleet {

/// Returns the messages of a batch for building automation over the hub's MQTT, as JSON
/// (docs/fleet.md): framewatch.BUILDING.state (topic framewatch/BUILDING/state) for the newest
/// heartbeat of a building, and framewatch.BUILDING.event for each event.
std::vector<Message> automation_messages(const FleetBatch& batch);

}  // namespace framewatch::fleet
